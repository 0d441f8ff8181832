"""What MkDocs does beyond its own for the manual: equations as MathML, the font of the equations, and the manual as one page for printing.

A page's equations stand between $ and $, or $$ and $$, as in the pages that a forge shows; arithmatex finds them.
"""
from __future__ import annotations

import html
import importlib.util
import itertools
import logging
import re
import shutil
from pathlib import Path

import latex2mathml.converter

log = logging.getLogger("mkdocs.hooks")
EQUATION = re.compile(r'<(span|div) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>', re.DOTALL)
printed: dict[str, str] = {}   # content of each page
titles: dict[str, str] = {}


def bold(letter: str) -> str:
    return chr((0x1D468 if letter.isupper() else 0x1D482) + ord(letter.lower()) - ord("a"))


def on_page_content(text: str, page, **_) -> str:
    """Write the page's equations as MathML."""

    def math(match: re.Match[str]) -> str:
        source = html.unescape(match[2]).strip()
        done = latex2mathml.converter.convert(source.replace("{aligned}", "{align*}"), display="inline" if match[1] == "span" else "block")
        if "\\" in done or "<mi>&</mi>" in done:
            log.warning("%s: not an equation: %s", page.file.src_path, source)
        done = re.sub(r"<mi>(sin|cos|tanh|ln|exp)</mi>", r'<mspace width="0.17em"/><mi>\1</mi><mspace width="0.1em"/>', done)
        sides = itertools.cycle(("prefix", "postfix"))   # of absolute values
        done = re.sub("<mo>&#x0007C;</mo>", lambda _: f'<mo form="{next(sides)}" stretchy="false">|</mo>', done)
        done = re.sub(r'mtd columnalign="(\w+)"', r'mtd style="text-align: \1"', done)   # browsers know no other alignment
        done = re.sub(r'<mi mathvariant="bold-italic">(\w)</mi>', lambda letter: f"<mi>{bold(letter[1])}</mi>", done)
        return done if match[1] == "span" else f'<div class="equation">{done}</div>'

    text = EQUATION.sub(math, text)
    text = re.sub(r"(?=</t[dh]>)", " ", text)   # else the index of the search has the words of neighbouring cells as one
    printed[page.file.name] = text
    titles[page.file.name] = page.title
    return text


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
    on_nav.pages = [page.file.name for page in nav.pages]


def on_post_build(config, **_) -> None:
    """Copy the font, and write print.html: all pages in their order, with links among them."""
    site = Path(config.site_dir)
    shutil.copy(next(Path(importlib.util.find_spec("ziamath").origin).parent.glob("fonts/STIXTwoMath*.ttf")), site / "STIXTwoMath.ttf")
    parts = []
    for name in on_nav.pages:
        text = re.sub(r'\bid="', f'id="{name}-', printed[name])
        text = re.sub(r'href="#', f'href="#{name}-', text)
        text = re.sub(r'href="(\w+)\.html(?:#([^"]*))?"', lambda m: f'href="#{m[1]}{"-" + m[2] if m[2] else ""}"' if m[1] in printed else m[0], text)
        parts.append(f'<section id="{name}">\n{text}\n</section>')
    style = "".join(f'<link rel="stylesheet" href="{sheet}">' for sheet in config.extra_css)
    contents = "".join(f'<li><a href="#{name}">{html.escape(titles[name])}</a></li>' for name in on_nav.pages[1:])
    parts.insert(1, f"<section><h1>Contents</h1><ol>{contents}</ol></section>")
    page = (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{config.site_name}</title>{style}</head>'
            f'<body class="print">{"".join(parts)}</body></html>')
    (site / "print.html").write_text(page, encoding="utf-8")
