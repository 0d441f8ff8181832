"""Style of all pictures: sizes for print, colours that colour-blind readers can distinguish (Okabe and Ito), legends, files."""

import math
import re
import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from gudgeon import language
from gudgeon.results import MissingResult
from matplotlib import font_manager
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import Collection, QuadMesh
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.ticker import FuncFormatter, Locator, LogLocator, MaxNLocator
from PIL import Image

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

#: How a picture that is kept is written: in pixels for pages of a forge, as vectors for those of the manual.
KEPT = ("png", "svg")

#: Largest part of a vector file that curves, marks and cells may have [bytes], bytes of one point, mark or cell, and resolution of the
#: parts that are pixels there because others would make the file larger: clouds of points, maps, chaotic traces [dots per inch].
VECTORS, BYTES, VECTOR_DPI = 80_000, {"point": 23, "mark": 110, "cell": 200}, 120

#: Families of fonts of which matplotlib brings one.
FAMILIES = ("serif", "sans-serif", "monospace")

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
    if name not in (*FAMILIES, *font_manager.get_font_names()):
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


class CrankAngles(Locator):
    """Ticks of an axis of crank angles [deg]: each 90 degrees, or 180, 360, ... of many turns; each 30, 15, 10, ... of parts of one."""

    def __call__(self) -> np.ndarray:
        return self.tick_values(*self.axis.get_view_interval())

    def tick_values(self, vmin: float, vmax: float) -> np.ndarray:
        low, high = sorted((vmin, vmax))
        if high - low < 180:
            return MaxNLocator(6, steps=[1, 1.5, 3, 10]).tick_values(low, high)
        step = 90.0
        while high - low > 8.5 * step:   # two turns and their margins have nine
            step *= 2
        return step * np.arange(np.ceil(low / step), np.floor(high / step) + 1)


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


def bytes_of(part: Line2D | Collection) -> int:
    """About the size of a part of a drawing in a vector file."""
    if isinstance(part, Line2D):
        marks = 0 if part.get_marker() in ("None", None, "") else len(part.get_xdata())
        line = part.get_transform().transform_path(part.get_path()) if part.get_linestyle() != "None" else None
        return BYTES["mark"] * marks + BYTES["point"] * (len(line.cleaned(simplify=True).vertices) if line else 0)
    if isinstance(part, QuadMesh):
        return BYTES["cell"] * np.size(part.get_array())
    return max(BYTES["mark"] * len(part.get_offsets()), BYTES["point"] * sum(len(path.vertices) for path in part.get_paths()))


def lighten(drawing: Drawing) -> None:
    """Make the largest parts of a drawing pixels in its vector files, until the others have at most VECTORS bytes."""
    parts = [*drawing.findobj(Line2D), *drawing.findobj(Collection)]
    sizes = sorted(((bytes_of(part), i) for i, part in enumerate(parts) if not part.get_rasterized()), reverse=True)
    rest = sum(size for size, _ in sizes)
    for size, i in sizes:
        if rest <= VECTORS:
            break
        parts[i].set_rasterized(True)
        rest -= size


def shortened(vectors: str) -> str:
    """An SVG without indentation and with places to a hundredth of a point: a fifth smaller."""
    places = re.compile(r' (?:d|x|y)="[^"]*"')
    return re.sub(r"\n +", "\n", places.sub(lambda found: re.sub(r"\d+\.\d{3,}", lambda number: f"{float(number[0]):.2f}", found[0]), vectors))


def save(drawing: Drawing, directory: Path, stem: str, formats: Sequence[str]) -> list[Path]:
    """Write a drawing in each format, in the language of the script. Dates are left out, so that equal results give equal files."""
    language.current.localise(drawing)
    fit_title(drawing)
    if "svg" in formats:
        lighten(drawing)
    directory.mkdir(parents=True, exist_ok=True)
    paths = []
    for form in formats:
        path = directory / f"{stem}.{form}"
        dateless = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}.get(form)
        with warnings.catch_warnings():
            warnings.filterwarnings("error", "constrained_layout not applied", UserWarning)
            try:
                drawing.savefig(path, metadata=dateless, dpi=VECTOR_DPI if form == "svg" else mpl.rcParams["savefig.dpi"])
            except UserWarning:
                raise MissingResult(f"{stem}: {drawing.get_figwidth() * 2.54:.1f} x {drawing.get_figheight() * 2.54:.1f} cm are too few for its parts: give a larger --size") from None
        if form == "svg":
            path.write_text(shortened(path.read_text(encoding="utf-8")), encoding="utf-8")
        paths.append(path)
    plt.close(drawing)
    return paths


def fewer_colours(picture: Path) -> None:
    """Write a PNG again with 128 colours of its own: a third of its bytes, without a difference that is seen."""
    with Image.open(picture) as image:
        image.convert("RGB").quantize(128, dither=Image.Dither.NONE).save(picture, optimize=True)


def keep(drawing: Drawing, picture: str | Path) -> list[Path]:
    """Write a drawing that is kept: to the path of its PNG, and as vectors beside it."""
    paths = save(drawing, Path(picture).parent, Path(picture).stem, KEPT)
    fewer_colours(paths[0])
    return paths
