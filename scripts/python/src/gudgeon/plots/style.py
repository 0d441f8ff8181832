"""Style of all pictures: sizes for print, colours that colour-blind readers can distinguish (Okabe and Ito), legends, files."""

import math
import warnings
from collections.abc import Iterable
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
from gudgeon import language
from gudgeon.results import MissingResult
from matplotlib import font_manager
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure as Drawing
from matplotlib.text import Text
from matplotlib.ticker import FuncFormatter, LogLocator

BLACK = "#000000"
ORANGE = "#E69F00"
GREEN = "#009E73"
BLUE = "#0072B2"
VERMILION = "#D55E00"
SKY = "#56B4E9"
PURPLE = "#CC79A7"
GREY = "#7F7F7F"

#: Width of the text on A4 [inch].
WIDTH = 6.3

#: Number of letters of a legend that fit side by side, and the number that a legend handle takes the place of.
LETTERS_IN_A_ROW, HANDLE_LETTERS = 125, 9

#: Size of the letters [points]; those of ticks and legends are smaller by one, titles larger by one.
FONT_SIZE = 8

SETTINGS = {
    "font.family": "DejaVu Sans",
    "font.size": FONT_SIZE,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
    "figure.titlesize": 9,
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.linewidth": 0.4,
    "grid.color": "#DDDDDD",
    "lines.linewidth": 0.8,
    "lines.solid_joinstyle": "round",
    "legend.frameon": False,
    "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-4, 5),
    "axes.xmargin": 0.01,
    "savefig.dpi": 200,
    "axes.prop_cycle": mpl.cycler(color=[BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK]),
    "svg.hashsalt": "gudgeon",
    "pdf.fonttype": 42,  # journals ask for TrueType
    "figure.constrained_layout.use": True,
}

mpl.rcParams.update(SETTINGS)


def use_font(name: str, size: float) -> bool:
    """Draw with a font in this size [points] from now on; False if the machine has no such font."""
    if name not in font_manager.get_font_names():
        return False
    sizes = {key: value * size / FONT_SIZE for key, value in SETTINGS.items() if key.endswith(("size", ".titlesize")) and key != "savefig.dpi"}
    mpl.rcParams.update(sizes | {"font.family": name})
    return True


def adapt(drawing: Drawing, title: str | None, words: Iterable[tuple[str, str]], size: tuple[float, float] | None) -> None:
    """Give a drawing another title, other words for its texts, another size [inch]."""
    if title is not None:
        drawing.suptitle(title)
    for text in drawing.findobj(Text):
        for old, new in words:
            if old in text.get_text():
                text.set_text(text.get_text().replace(old, new))
    if size:
        drawing.set_size_inches(size)


def mark_decades(axis: Axis) -> None:
    """Label a logarithmic axis with 0.1, 1, 10; with less than three decades also at 2 and 5; with less than one at 1, 2, 3, 4, 6
    and 8."""
    low, high = sorted(axis.get_view_interval())
    subs = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0) if high < 10 * low else (1.0, 2.0, 5.0) if high < 1e3 * low else (1.0,)
    axis.set_major_locator(LogLocator(10, subs=subs))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(FuncFormatter(lambda value, _: ""))


def add_legend(drawing: Drawing, axes: Iterable[Axes], markerscale: float = 1.0) -> None:
    """One legend for all axes, below them, with each label once."""
    entries = {}
    for axis in axes:
        for handle, text in zip(*axis.get_legend_handles_labels()):
            entries.setdefault(text, handle)
    if entries:
        needed = sum(len(text) + HANDLE_LETTERS for text in entries)
        rows = math.ceil(needed / LETTERS_IN_A_ROW * (WIDTH / drawing.get_figwidth()))
        drawing.legend(
            entries.values(),
            entries.keys(),
            loc="outside lower center",
            ncols=math.ceil(len(entries) / max(rows, 1)),
            markerscale=markerscale,
        )


def fit_title(drawing: Drawing) -> None:
    """Print the title of a drawing smaller if it is wider than the drawing: those in other languages can be."""
    title = drawing._suptitle
    if title is None:
        return
    drawing.canvas.draw()
    box, width = title.get_window_extent(), drawing.canvas.get_width_height()[0]
    room = width - max(box.x0, 0.0) if title.get_horizontalalignment() == "left" else width
    if box.width > room:
        title.set_fontsize(title.get_fontsize() * 0.98 * room / box.width)


def save(drawing: Drawing, directory: Path, stem: str, formats: Iterable[str]) -> list[Path]:
    """Write a drawing in each format, in the language of the script. Dates are left out, so that equal results give equal files."""
    language.current.localise(drawing)
    fit_title(drawing)
    directory.mkdir(parents=True, exist_ok=True)
    paths = []
    for form in formats:
        path = directory / f"{stem}.{form}"
        dateless = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}.get(form)
        with warnings.catch_warnings():
            warnings.filterwarnings("error", "constrained_layout not applied", UserWarning)
            try:
                drawing.savefig(path, metadata=dateless)
            except UserWarning:
                raise MissingResult(f"{stem}: {drawing.get_figwidth() * 2.54:.1f} x {drawing.get_figheight() * 2.54:.1f} cm are too few for its parts: give a larger --size") from None
        paths.append(path)
    plt.close(drawing)
    return paths
