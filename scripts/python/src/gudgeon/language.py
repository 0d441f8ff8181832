"""Pictures in another language: when a drawing is saved, its texts are translated and its numbers get decimal commas.

A translation is a text or a template, in which "{}" stands for a part that is translated separately. Lines are translated one by
one.
"""

import argparse
import re
import sys
from typing import TYPE_CHECKING

from gudgeon.portuguese import TEXTS, UNTRANSLATED

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

LANGUAGES = ("en", "pt")

_WORD = re.compile(r"[^\W\d_²³]{2,}")
_COMMA = re.compile(r"(?<=\d)\.(?=\d)")


class Language:
    """Translates texts. `unknown` collects texts without translation."""

    def __init__(self, name: str = "en") -> None:
        self.name = name
        self.unknown: set[str] = set()
        self.names: set[str] = set()
        found = TEXTS if name == "pt" else {}
        self.exact = {text: said for text, said in found.items() if "{}" not in text}
        self.templates = [
            (re.compile(re.escape(text).replace(r"\{\}", "(.+?)") + r"\Z", re.DOTALL), said)
            for text, said in sorted(found.items(), key=lambda item: -len(item[0].replace("{}", "")))
            if "{}" in text
        ]

    def keep(self, name: str) -> str:
        """Take a text as a name that the user gave, which is not translated; the text itself. A number is no name."""
        if re.search(r"[^\d.]", name):
            self.names.add(name)
        return name

    @property
    def is_english(self) -> bool:
        return self.name == "en"

    def number(self, text: str) -> str:
        """The text with decimal commas, set in formulas so that no space follows the comma."""
        return text if self.is_english else _COMMA.sub("{,}" if "$" in text else ",", text)

    def say(self, text: str) -> str:
        """The translation of a text of one or more lines."""
        if self.is_english:
            return text
        if text.strip() in self.exact:  # a translation of the whole text, with its lines
            return self.exact[text.strip()]
        return "\n".join(self._line(line) for line in text.split("\n")).replace("[deg]", "[graus]")

    def _line(self, text: str) -> str:
        if figure := re.match(r"([0-9A-Z]\.[0-9]+  )(.*)", text):  # numbers of figures keep the decimal point
            return figure[1] + self._line(figure[2])
        if text in self.exact:
            return self.exact[text]
        if text in self.names:
            return text
        for pattern, said in self.templates:
            if match := pattern.match(text):
                for part in match.groups():
                    said = said.replace("{}", self._line(part), 1)
                return said
        head, _, last = text.rpartition(" ")
        if head and last in self.names and last not in self.exact:   # a name behind what it is, as in "friction lugre"
            return f"{self._line(head)} {last}"
        if text[:1].isupper() and (text[0].lower() + text[1:]) in self.exact:
            said = self.exact[text[0].lower() + text[1:]]
            return said[0].upper() + said[1:]
        if any(word not in UNTRANSLATED for word in _WORD.findall(re.sub(r"\$[^$]*\$|</?\w+>", "", text))):
            self.unknown.add(text)
        return self.number(text)

    def localise(self, drawing: "Drawing") -> None:
        """Translate every text of a drawing. Call it once for each drawing."""
        if self.is_english or getattr(drawing, "_gudgeon_language", "en") == self.name:
            return
        from gudgeon.plots.localised import localise

        localise(drawing, self)
        drawing._gudgeon_language = self.name

    def warn(self, script: str) -> None:
        """Print a line on standard error if texts have no translation."""
        if self.unknown:
            print(f"{script}: no translation of: {'; '.join(sorted(self.unknown))}", file=sys.stderr)


#: The language of all pictures of a script.
current = Language()


def use(name: str) -> Language:
    """Set the language of all pictures that are saved afterwards."""
    global current
    current = Language(name)
    return current


def add_option(parser: argparse.ArgumentParser) -> None:
    """Add the option --language, which takes effect while the command line is read."""

    class Use(argparse.Action):
        def __call__(self, parser: object, namespace: argparse.Namespace, value: str, option: str | None = None) -> None:
            setattr(namespace, self.dest, value)
            use(value)

    parser.add_argument(
        "--language", choices=LANGUAGES, default="en", action=Use, help="language of the pictures; pt also has decimal commas (default: en)"
    )
