"""Style of the figures: sizes for print, colours that colour-blind readers can distinguish (Okabe and Ito)."""

import matplotlib as mpl
from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter, LogLocator

mpl.use("Agg")

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

SETTINGS = {
    "font.family": "DejaVu Sans",
    "font.size": 8,
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
    "svg.hashsalt": "gudgeon",
    "figure.constrained_layout.use": True,
}

mpl.rcParams.update(SETTINGS)


def mark_decades(axis: Axis) -> None:
    """Label a logarithmic axis with 0.1, 1, 10; with less than three decades also at 2 and 5; with less than one at 1, 2, 3, 4, 6
    and 8."""
    low, high = sorted(axis.get_view_interval())
    subs = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0) if high < 10 * low else (1.0, 2.0, 5.0) if high < 1e3 * low else (1.0,)
    axis.set_major_locator(LogLocator(10, subs=subs))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(FuncFormatter(lambda value, _: ""))
