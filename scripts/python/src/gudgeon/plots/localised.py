"""The texts and numbers of a drawing in another language."""

from collections.abc import Iterable

from gudgeon.language import Language
from matplotlib.artist import Artist
from matplotlib.figure import Figure as Drawing
from matplotlib.text import Text
from matplotlib.ticker import Formatter, NullFormatter


class LocalFormatter(Formatter):
    """Formats numbers as another formatter does, but with decimal commas and translated words."""

    def __init__(self, inner: Formatter, language: Language) -> None:
        self.inner, self.language = inner, language

    def set_axis(self, axis: object) -> None:
        super().set_axis(axis)
        self.inner.set_axis(axis)

    def set_locs(self, locs: object) -> None:
        self.inner.set_locs(locs)

    def __call__(self, x: float, pos: int | None = None) -> str:
        return self.language.say(self.inner(x, pos))

    def format_ticks(self, values: Iterable[float]) -> list[str]:
        return [self.language.say(text) for text in self.inner.format_ticks(values)]

    def get_offset(self) -> str:
        return self.language.number(self.inner.get_offset())


def localise(drawing: Drawing, language: Language) -> None:
    """Translate every text of a drawing."""
    drawing.canvas.draw()
    ticks: set[Artist] = set()
    for axes in drawing.axes:
        for axis in axes._axis_map.values():
            for get, put in (("get_major_formatter", "set_major_formatter"), ("get_minor_formatter", "set_minor_formatter")):
                inner = getattr(axis, get)()
                if not isinstance(inner, (NullFormatter, LocalFormatter)):
                    getattr(axis, put)(LocalFormatter(inner, language))
            ticks.update(label for tick in (*axis.majorTicks, *axis.minorTicks) for label in (tick.label1, tick.label2))
            ticks.add(axis.offsetText)
    for text in drawing.findobj(Text):
        if text not in ticks and text.get_text().strip():
            text.set_text(language.say(text.get_text()))
