"""The page of one run: everything in one HTML file that needs no network.

The trace is stored as float32 columns, and the part of plotly.js that draws lines unchanged (npm: plotly.js-basic-dist-min 4.1.1, gzip -9n);
both are compressed by gzip and unpacked by the browser.
"""

import base64
import gzip
import html
import json
import re
from collections.abc import Mapping
from pathlib import Path

import pandas as pd
from gudgeon.language import Language
from gudgeon.names import PLACES
from gudgeon.report import answers
from gudgeon.report.case_rows import case_rows, defaults
from gudgeon.report.scene import scene_of
from gudgeon.results import Run

PAGE = Path(__file__).parent / "assets"

LIBRARY = PAGE / "plotly-basic.min.js.gz"

#: Quantities of a summary that concern the program and not the run.
OF_THE_PROGRAM = ("identity", "version", "compiler", "compiler_options", "trace_bytes", "events_bytes")

#: Parts of a page that its line of contents leads to, if the run has them: what they are called.
CONTENTS = (("answers", "Answers"), ("losses", "Losses"), ("motion", "Motion"), ("curves", "Plots"), ("more-plots", "More plots"), ("wear", "Wear"),
            ("cycles", "Settled cycles"), ("summary", "Summary"), ("case", "Case"), ("program", "Program"))


def page(
    run: Run,
    ideal: Run | None = None,
    fields: list[pd.DataFrame] | None = None,
    language: Language | None = None,
    cycle_columns: list[str] | None = None,
    worn: list[tuple[str, pd.DataFrame]] | None = None,
) -> str:
    """The HTML text of the page. `fields`: the pressures of a NAME.film.csv; `cycle_columns`: columns whose cycles and orders are
    shown; `worn`: the worn surfaces of a NAME.wear.csv."""
    from gudgeon.report import cycles as report_cycles

    language = language or Language()
    say = language.say
    scene, data = scene_of(run, ideal, fields, language)
    scene |= spoken(language, "drawing", "page")
    said = [*warnings(run, language), *notes(run)]
    known = defaults()
    left_out = say("Keys that have their defaults are left out." if known is not None else "Keys that are empty, 0 or no are left out.")
    case = "".join(rows_html(rows, f"&{group}") for group, rows in case_rows(run, known, language))

    def summary(of_program: bool) -> str:
        return rows_html(
            [
                (name, summary_number(value, language), "" if unit == "1" else unit)
                for name, (value, unit) in run.summary.items()
                if not name.startswith(("steps_of_order", "note_")) and (name in OF_THE_PROGRAM) == of_program
            ]
        )

    parts = {
        "title": html.escape(str(run.parameter("case", "title", "")) or run.name),
        "subtitle": html.escape(
            f"{run.name}: "
            + say(
                f"{len(run['time'])} samples over {run['time'][-1]:.6g} s"
                + (f", of which {scene['rows']} are kept here, peaks among them" if scene["rows"] < len(run["time"]) else "")
            )
        ),
        "language": language.name,
        "style": (PAGE / "page.css").read_text(encoding="utf-8"),
        "drawing": (PAGE / "drawing.js").read_text(encoding="utf-8"),
        "script": (PAGE / "page.js").read_text(encoding="utf-8"),
        "warnings": "".join(f'<p class="warning">{html.escape(text)}</p>' for text in said)
        or f'<p class="fine">{html.escape(say("No warnings."))}</p>',
        "wear": wear_section(worn, language) if worn else "",
        "answers": answers.section(run, language),
        "cycles": report_cycles.section(run, cycle_columns, language),
        "summary": f"<div><table>{summary(False)}</table></div>",
        "program": f"<div><table>{summary(True)}</table></div>",
        "case": f'<p class="hint">{html.escape(left_out)}</p><div><table>{case}</table></div>',
        "footer": html.escape(
            f"gudgeon {run.summary.get('version', ('', ''))[0]}. "
            + say(
                "Film pressures are computed for this page from the motion in the trace. Plots by plotly.js, MIT licence."
            )
        ),
        "scene": json.dumps(scene, ensure_ascii=False).replace("</", "<\\/"),
        **{name: packed(content) if content else "" for name, content in data.items()},
        "library": base64.b64encode(LIBRARY.read_bytes()).decode("ascii"),
    }
    there = "".join(parts.values()) + text_of("page.html", language)
    parts["contents"] = " ".join(f'<a href="#{name}">{html.escape(say(said))}</a>' for name, said in CONTENTS if f'id="{name}"' in there)
    return filled(text_of("page.html", language), parts)


def packed(data: bytes) -> str:
    """Bytes compressed by gzip, as base64 text; equal bytes give equal texts."""
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode("ascii")


def warnings(run: Run, language: Language) -> list[str]:
    """What a reader has to know of a run besides its notes: how far it is certified, why it ended early, what its answers lack."""
    found = answers.warnings(run)
    if (until := run.certified_until) is not None:
        found.append(
            f"The run is certified up to {answers.amount(until, 's')}: beyond, shaded in the plots, single values are not reliable. How far "
            "results of the whole run are is in the summary (..._difference)."
        )
    status = run.summary.get("status", ("unknown", ""))[0]
    if status != "done":
        found.append(f"The run did not end as requested: {language.keep(status)}.")
    return [language.say(text) for text in found]


def notes(run: Run) -> list[str]:
    """The notes of the summary, in the words of the program."""
    return [text for name, (text, _) in run.summary.items() if name.startswith("note_")]


def rows_html(rows: list[tuple[str, ...]], heading: str = "") -> str:
    def cell(text: str, is_name: bool) -> str:   # long texts take several lines, paths too; a short value never; names are broken behind a "_"
        is_long, escaped = len(text) > 30, html.escape(text)
        kind = ' class="text"' if is_long else ""
        return f"<td{kind}>{escaped.replace('_', '_<wbr>') if is_long or is_name else escaped}</td>"

    cells = ["<tr>" + "".join(cell(text, place == 0) for place, text in enumerate(row)) + "</tr>" for row in rows]
    head = f'<tr><th colspan="3">{html.escape(heading)}</th></tr>' if heading else ""
    return head + "".join(cells)


def summary_number(text: str, language: Language) -> str:
    try:
        return language.number(f"{float(text):.6g}")
    except ValueError:
        return text


def text_of(name: str, language: Language) -> str:
    """A file of the pages with the parts that they share, its texts in [[...]] translated."""
    text = (PAGE / name).read_text(encoding="utf-8")
    for part in ("head", "motion"):
        text = text.replace(f"{{{{{part}}}}}", (PAGE / f"{part}.html").read_text(encoding="utf-8"))
    return re.sub(r"\[\[(.+?)\]\]", lambda found: html.escape(language.say(found[1])), text)


def filled(text: str, parts: Mapping[str, str]) -> str:
    """A text with {{fields}}, each filled once, so that inserted texts are not searched for fields."""
    head, *fields = text.split("{{")
    return head + "".join(parts[name] + rest for name, rest in (field.split("}}", 1) for field in fields))


def wear_section(worn: list[tuple[str, pd.DataFrame]], language: Language) -> str:
    """The section on worn surfaces as HTML."""
    from gudgeon.plots import wear as wear_pictures
    from gudgeon.report import cycles as report_cycles

    heading = language.say("Wear of pin and bore")
    drawing = wear_pictures.draw(worn, [PLACES[joint][1] for joint, _ in worn])
    said = "Depth around each surface, exaggerated, and over the angle on it"
    return f'<section id="wear"><h2>{html.escape(heading)}</h2>{report_cycles.picture(drawing, said, language)}</section>'


def script_words(*scripts: str) -> list[str]:
    """The texts in scripts of the pages: those in W(...)."""
    found = {word for name in scripts for word in re.findall(r'\bW\("([^"]+)"\)', (PAGE / f"{name}.js").read_text(encoding="utf-8"))}
    return sorted(found)


def spoken(language: Language, *scripts: str) -> dict[str, object]:
    """What drawing.js calls `spoken`: the words of these scripts in the page's language, and whether numbers have decimal commas."""
    return {"words": {word: language.say(word) for word in script_words(*scripts)}, "comma": not language.is_english}
