"""What MkDocs does beyond its own for the manual: equations as MathML with numbers, the font of the equations, powers of ten, units, minus signs and
ranges as they are printed, and the manual as one page for printing.

A page's equations stand between $ and $, or $$ and $$, as in the pages that a forge shows; arithmatex finds them.
"""
from __future__ import annotations

import html
import importlib.util
import itertools
import logging
import re
from pathlib import Path

import latex2mathml.converter
from fontTools import subset, ttLib

log = logging.getLogger("mkdocs.hooks")
EQUATION = re.compile(r'<(span|div) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>', re.DOTALL)
PART = re.compile(r"<(pre|code|math|script|style|svg)\b.*?</\1>|<[^>]+>|[^<]+", re.DOTALL)   # what stays as it is, a tag, or a text
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
PRINTED = (   # what a page has outside of code, and how it is printed
    (re.compile(r"(?<![\w.])\d(?:\.\d+)?[eE]\+?0?[0-2]\b"), lambda found: f"{float(found[0]):g}"),
    (re.compile(r"(?<![\w.])1(?:\.0+)?[eE]\+?(-?\d+)\b"), lambda found: "10" + power(found[1])),
    (re.compile(r"(?<![\w.])(\d+(?:\.\d+)?)[eE]\+?(-?\d+)\b"), lambda found: f"{found[1]}·10{power(found[2])}"),
    (re.compile(r"(?<=[A-Za-z)])\^(-?\d+)(?![\d.])"), lambda found: found[1].translate(RAISED)),
    (re.compile(r"(?<=[A-Za-z)])\^(-?\d+\.\d+)"), r"<sup>\1</sup>"),
    (re.compile(r"(?<![\w.-])(\d+(?:\.\d+)?)-(\d+(?:\.\d+)?)(?![\w-])"), r"\1–\2"),
    (re.compile(r"(?<![\w).\]-])-(?=\d)"), "−"),
    (re.compile(r"(?<=\d )um\b"), "µm"),
    (re.compile(r"(?<!/)\bcm3\b"), "cm³"),
)
TABLE, CELL = re.compile(r"<table>.*?</table>", re.DOTALL), re.compile(r"<td>(?=(.*?)</td>)", re.DOTALL)
MANY = 5   # pages with more pictures read them as they come into view
UNWRITTEN = {*range(0x1D434, 0x1D468), *range(0x1D6E2, 0x1D71C), 0x210E, 0x221A}   # browsers draw letters of equations by these, and roots
printed: dict[str, str] = {}   # content of each page
titles: dict[str, str] = {}


def bold(letter: str) -> str:
    return chr((0x1D468 if letter.isupper() else 0x1D482) + ord(letter.lower()) - ord("a"))


def power(digits: str) -> str:
    return str(int(digits)).translate(RAISED)


def typeset(text: str) -> str:
    """The text of a page with its numbers and units as they are printed; code, equations and tags stay."""

    def said(part: re.Match[str]) -> str:
        words = part[0]
        if not words.startswith("<"):
            for found, better in PRINTED:
                words = found.sub(better, words)
        return words

    return PART.sub(said, text)


def on_page_content(text: str, page, **_) -> str:
    """Write the page's equations as MathML, with numbers, and its numbers as they are printed."""
    numbers = itertools.count(1)

    def math(match: re.Match[str]) -> str:
        source = html.unescape(match[2]).strip()
        done = latex2mathml.converter.convert(source.replace("{aligned}", "{align*}"), display="inline" if match[1] == "span" else "block")
        if "\\" in done or "<mi>&</mi>" in done:
            log.warning("%s: not an equation: %s", page.file.src_path, source)
        done = re.sub(r"(<msup>)?<mi>(sin|cos|tanh|ln|exp)</mi>",   # a power has two parts, without spaces between them
                      lambda m: f'<mspace width="0.17em"/>{m[1] or ""}<mi>{m[2]}</mi>' + ("" if m[1] else '<mspace width="0.1em"/>'), done)
        sides = itertools.cycle(("prefix", "postfix"))   # of absolute values
        done = re.sub("<mo>&#x0007C;</mo>", lambda _: f'<mo form="{next(sides)}" stretchy="false">|</mo>', done)
        done = re.sub(r'mtd columnalign="(\w+)"', r'mtd style="text-align: \1"', done)   # browsers know no other alignment
        done = re.sub(r'<mi mathvariant="bold-italic">(\w)</mi>', lambda letter: f"<mi>{bold(letter[1])}</mi>", done)
        if match[1] == "span":
            return done
        number = next(numbers)
        return f'<div class="equation" id="equation-{number}">{done}<a class="number" href="#equation-{number}">eq. {number}</a></div>'

    text = typeset(EQUATION.sub(math, text))
    for heading in headings(page.toc):
        heading.title = typeset(heading.title)
    text = re.sub(r"(?=</t[dh]>)", " ", text)   # else the index of the search has the words of neighbouring cells as one
    printed[page.file.name] = text
    titles[page.file.name] = page.title
    if page.file.name in ("index", "gallery"):
        text = TABLE.sub(labelled, text)
    return text.replace("<img ", '<img loading="lazy" ') if text.count("<img ") > MANY else text


def labelled(table: re.Match[str]) -> str:
    """A table whose cells, but for empty ones, say their column: on phones these are lines instead of cells. The first cell and the second of two
    need no name."""
    names = [html.escape(re.sub(r"<[^>]+>", "", head).strip()) + ": " for head in re.findall(r"<th>(.*?)</th>", table[0], re.DOTALL)]
    heads = itertools.cycle(["", *(names[1:] if len(names) > 2 else [""])])

    def cell(found: re.Match[str]) -> str:
        head = next(heads)
        return f'<td data-label="{head}">' if found[1].strip() else found[0]

    return CELL.sub(cell, table[0])


def headings(items):
    """The headings of a page, at all depths."""
    for item in items:
        yield item
        yield from headings(item.children)


def on_page_markdown(text: str, page, **_) -> str:
    """The search finds the answers of the table "I want" on the first page first: titles and tags weigh more than text there."""
    if page.file.name == "index":
        page.meta["tags"] = re.findall(r"^\| ([a-z][^|]*) \|", text.split("| I want |")[1].split("\n\n")[0], re.MULTILINE)
    return text


def on_post_page(output: str, page, **_) -> str:
    """Pages in Portuguese say so."""
    return output.replace('<html lang="en"', '<html lang="pt-BR"', 1) if page.file.name.endswith("_pt") else output


def on_nav(nav, **_) -> None:
    printed.clear()
    on_nav.pages = [page.file.name for page in nav.pages if page.file.is_documentation_page()]


def write_font(path: Path) -> None:
    """Write the font of the equations with the letters that the pages have."""
    math = "".join(itertools.chain.from_iterable(re.findall(r"<math.*?</math>", text, re.DOTALL) for text in printed.values()))
    letters = {ord(letter) for letter in html.unescape(re.sub(r"<[^>]+>", "", math))}
    font = ttLib.TTFont(next(Path(importlib.util.find_spec("ziamath").origin).parent.glob("fonts/STIXTwoMath*.ttf")))
    chosen = subset.Subsetter(subset.Options(layout_features=["*"]))
    chosen.populate(unicodes=letters | UNWRITTEN)
    chosen.subset(font)
    font.flavor = "woff"
    font.save(path)


def on_post_build(config, **_) -> None:
    """Write the font, and print.html: all pages in their order, with links among them. pages.py puts the numbers of the pages into its contents."""
    site = Path(config.site_dir)
    write_font(site / "STIXTwoMath.woff")
    parts = []
    for number, name in enumerate(on_nav.pages):   # the first page stands before the contents
        text = re.sub(r'\bid="', f'id="{name}-', printed[name])
        text = re.sub(r'href="#', f'href="#{name}-', text)
        text = re.sub(r'href="(\w+)\.html(?:#([^"]*))?"', lambda m: f'href="#{m[1]}{"-" + m[2] if m[2] else ""}"' if m[1] in printed else m[0], text)
        text = re.sub(r">eq\. (\d+)</a>", rf">eq. {number}.\1</a>", text)
        parts.append(f'<section id="{name}">\n{text}\n</section>')
    style = "".join(f'<link rel="stylesheet" href="{sheet}">' for sheet in config.extra_css)
    contents = "".join(f'<li><a href="#{name}">{html.escape(titles[name])}</a><span class="page" data-page="{name}">000</span></li>' for name in on_nav.pages[1:])
    parts.insert(1, f'<section><h1>Contents</h1><ol class="contents">{contents}</ol></section>')
    page = (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{config.site_name}</title>{style}</head>'
            f'<body class="print">{"".join(parts)}</body></html>')
    (site / "print.html").write_text(page, encoding="utf-8")
