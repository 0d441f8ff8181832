"""The page's section on settled cycles: means with their scatter, orders and spectra of chosen columns, work and losses."""

import base64
import html
import io

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from gudgeon.cycles import Cycles, orders, whole_cycles, work
from gudgeon.language import Language
from gudgeon.plots import cycles as cycle_pictures
from gudgeon.report.answers import amount, number
from gudgeon.results import MissingResult, Run
from matplotlib.figure import Figure as Drawing

COLUMNS = ("crank_speed", "piston_acceleration", "guide_force", "frame_force_x", "crank_moment", "film_thickness")
SETTLED = 0.05  # largest drift of a column's mean over the cycles, divided by the column's range
HIGHEST = 20.0  # highest order shown


def chosen(cycles: Cycles, wanted: list[str] | None) -> list[str]:
    """The columns to analyse. Raises MissingResult for a column that the trace lacks."""
    if wanted:
        for name in wanted:
            if name not in cycles:
                raise MissingResult(f"no column {name} in the trace; it has: {' '.join(cycles.values)}")
        return wanted
    return [name for name in COLUMNS if name in cycles and cycles[name].max() > cycles[name].min()]


def drift(cycles: Cycles, column: str) -> float:
    """Change of the mean of a column from the first cycle to the last, relative to the column's range."""
    means = cycles[column].mean(axis=1)
    return float(abs(means[-1] - means[0]) / (np.ptp(cycles[column]) or 1.0))


def section(run: Run, wanted: list[str] | None = None, language: Language | None = None) -> str:
    """The section as HTML. If the run has no settled cycles and no columns are requested, one line that states the reason. Raises
    MissingResult for a column that the trace lacks."""
    language = language or Language()
    try:
        cycles = whole_cycles(run)
    except MissingResult as problem:
        if wanted:
            raise
        return paragraph(language.say(f"None: {str(problem).split(': ', 1)[-1]}."))
    columns = chosen(cycles, wanted)
    if reason := why_none(run, cycles, columns, bool(wanted)):
        return paragraph(language.say(reason))
    length = cycles.length / (2 * np.pi)
    text = f"{cycles.number} {'cycle' if cycles.number == 1 else 'cycles'} of {'one revolution' if length < 1.5 else f'{length:g} revolutions'}, "
    text += "the last half of the run" + (", which is periodic." if is_periodic(run) else ".")
    means, by_order = "Means of each column over the cycle, and their scatter", "Amplitudes by order, and densities by frequency"
    return "".join(
        (
            paragraph(language.say(text)),
            '<div class="pictures">',
            picture(cycle_pictures.draw_means(cycles, columns), means, language),
            picture(cycle_pictures.draw_orders(cycles, columns, HIGHEST), by_order, language),
            "</div>",
            table(strongest(cycles, columns), "Strongest orders (amplitude; order 0: mean)", language),
            table(done, "Work in the last cycle", language) if len(done := readable_work(work(run))) else "",
        )
    )


def is_periodic(run: Run) -> bool:
    return run.summary.get("motion", ("", ""))[0] == "periodic"


def why_none(run: Run, cycles: Cycles, columns: list[str], is_wanted: bool) -> str:
    """The reason why the cycles of a run are not shown; empty if they are shown."""
    if not columns:
        return "None: no column changes."
    if is_periodic(run) or is_wanted:
        return ""
    if cycles.number < 2:
        return "None: the second half of the run has a single whole cycle, which does not show whether the motion has settled."
    worst = max(columns, key=lambda name: drift(cycles, name))
    if drift(cycles, worst) <= SETTLED:
        return ""
    share = f"{100 * drift(cycles, worst):.0f} %"
    return f"None: the motion has not settled. The mean of {worst.replace('_', ' ')} drifts by {share} of its range over the last half of the run."


def strongest(cycles: Cycles, columns: list[str]) -> pd.DataFrame:
    """The mean and the four strongest orders of each column."""
    rows = []
    for column in columns:
        found = orders(cycles, column)
        most = found[(found["order"] > 0) & (found["order"] <= HIGHEST)].nlargest(4, "amplitude")
        shown = cycle_pictures.shown(cycles, column)
        row = {"column": shown.label, "mean": number(shown.factor * cycles[column].mean())}
        row |= {f"strongest {k + 1}": f"{line.order:g}: {number(shown.factor * line.amplitude)}" for k, line in enumerate(most.itertuples())}
        rows.append(row)
    return pd.DataFrame(rows)


def readable_work(done: pd.DataFrame) -> pd.DataFrame:
    """The work of a cycle as texts, each with its unit."""
    columns = {"work[J]": ("work", "J"), "mean_effective_pressure[Pa]": ("mean effective pressure", "bar")}
    return pd.DataFrame({"quantity": done["quantity"]} | {said: [amount(value, unit) for value in done[name]] for name, (said, unit) in columns.items() if name in done}) \
        if len(done) else done


def paragraph(text: str) -> str:
    return f'<p class="hint">{html.escape(text)}</p>'


def picture(drawing: Drawing, said: str, language: Language) -> str:
    """A drawing as an image inside the page."""
    said = language.say(said)
    drawing.suptitle("")  # the page already names the run
    language.localise(drawing)
    buffer = io.BytesIO()
    drawing.savefig(buffer, format="png", dpi=110, metadata={"Software": None})
    plt.close(drawing)
    data = base64.b64encode(buffer.getvalue()).decode("ascii")
    return f'<figure><img class="cycles" alt="{html.escape(said)}" src="data:image/png;base64,{data}"><figcaption>{html.escape(said)}</figcaption></figure>'


def table(data: pd.DataFrame, heading: str, language: Language) -> str:
    say = language.say
    head = "".join(f"<th>{html.escape(say(str(name)))}</th>" for name in data.columns)
    rows = "".join("<tr>" + "".join(f"<td>{html.escape(say(str(cell)))}</td>" for cell in row) + "</tr>" for row in data.itertuples(index=False))
    return f"<h3>{html.escape(say(heading))}</h3><table><tr>{head}</tr>{rows}</table>"
