"""The commands of gudgeon-plot, one module each: `add_arguments(parser)` and `run(options) -> int`."""

import argparse
import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

FORMATS = ("png", "svg", "pdf")


class Refused(Exception):
    """A command line whose options do not fit together."""


def number(least: float, *, itself: bool = True, whole: bool = False) -> Callable[[str], float]:
    """A type for argparse: a finite number of at least `least`; with itself=False larger than it; with `whole` without fraction."""
    wanted = f"must be a {'whole ' if whole else ''}number {'>=' if itself else '>'} {least:g}"

    def convert(text: str) -> float:
        try:
            value = int(text) if whole else float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value) or value < least or (value == least and not itself):
            raise argparse.ArgumentTypeError(f"{text}: {wanted}")
        return value

    return convert


class Names(argparse.Action):
    """Takes names apart that blanks or commas separate."""

    def __call__(self, parser: object, namespace: argparse.Namespace, values: object, option: str | None = None) -> None:
        setattr(namespace, self.dest, [name for word in values for name in word.split(",") if name])


def _folder(text: str) -> Path:
    if Path(text).suffix[1:] in FORMATS:
        raise argparse.ArgumentTypeError(f"{text}: give a folder, since several files are written")
    return Path(text)


def add_output(parser: argparse.ArgumentParser, place: str = "beside the data", several: bool = False) -> None:
    """Add -o and --format. With `several` pictures -o is a folder; else it may also be a file."""
    what = "folder" if several else "folder or file"
    parser.add_argument("-o", "--out", type=_folder if several else Path, metavar="PATH", help=f"{what} for the pictures (default: {place})")
    parser.add_argument("--format", action="append", choices=FORMATS, help="repeatable (default: png)")
    paper = parser.add_argument_group("for papers")
    paper.add_argument("--title", metavar="TEXT", help="title of the picture ('': none)")
    paper.add_argument("--label", action="append", type=_replacement, metavar="OLD=NEW", default=[], help="other words for a text of the picture; repeatable")
    paper.add_argument("--size", type=_size, metavar="WxH", help="width and height in cm: 8.5x6")
    paper.add_argument("--font", type=_font, metavar="NAME[,SIZE]", help="font, and its size in points (default: DejaVu Sans,8)")
    paper.add_argument("--rpm", action=_Rpm, help="crank speeds in rpm or rad/s (default: in rpm, but keys of studies as they are given)")


def _replacement(text: str) -> tuple[str, str]:
    old, equals, new = text.partition("=")
    if not (old and equals):
        raise argparse.ArgumentTypeError(f"{text}: must be OLD=NEW")
    return old, new


def _size(text: str) -> tuple[float, float]:
    """Width and height in inches, from centimetres."""
    width, _, height = text.partition("x")
    measure = number(1)
    try:
        return measure(width) / 2.54, measure(height) / 2.54
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(f"{text}: must be WxH, width and height in cm of at least 1: 8.5x6") from None


def _font(text: str) -> str:
    """Take a font for all pictures that are drawn from now on."""
    from gudgeon.plots import style

    name, _, size = text.partition(",")
    if not style.use_font(name.strip(), number(1)(size) if size else style.FONT_SIZE):
        raise argparse.ArgumentTypeError(f"{name}: no such font on this machine; {', '.join(style.FAMILIES)} are always there")
    return text


class _Rpm(argparse.BooleanOptionalAction):
    """Show crank speeds in rpm, or in rad/s, in all pictures that are drawn from now on."""

    def __call__(self, parser: object, namespace: argparse.Namespace, values: object, option: str | None = None) -> None:
        from gudgeon import names

        names.speeds_in_rpm(not (option or "").startswith("--no-"))


def add_results(parser: argparse.ArgumentParser) -> None:
    """Add the folder in which results are looked for, and --no-run."""
    parser.add_argument("--results", type=Path, metavar="DIR", help="folder of the results (default: results, or that of the given file)")
    parser.add_argument("--no-run", action="store_true", help="do not run cases; print the command where a result is missing")


def save(drawing: "Drawing", options: argparse.Namespace, folder: Path, stem: str) -> list[Path]:
    """Write a drawing as -o, --format and the options for papers say, by default into `folder` as `stem`; prints and returns the paths."""
    from gudgeon import language
    from gudgeon.plots import style

    language.current.localise(drawing)
    style.adapt(drawing, options.title, options.label, options.size)
    out = options.out
    if out and out.suffix[1:] in FORMATS:
        paths = style.save(drawing, out.parent, out.stem, [out.suffix[1:]])
    else:
        paths = style.save(drawing, out or folder, stem, options.format or ["png"])
    print(*paths)
    return paths
