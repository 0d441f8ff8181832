#!/usr/bin/env python3
"""Draws the mechanism, its joints, forces and numberings for the manual, from the keys of shipped cases and the equations of the page on the
mechanism: what is drawn has the proportions and signs of a run. x is up, y to the right, angles from x to y are clockwise.

    scripts/manual/drawings.py [FOLDER]     default: data/manual/drawings
"""
from __future__ import annotations

import html
import re
import sys
from math import asin, atan2, cos, degrees, hypot, pi, radians, sin
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
INK, GREY, LIGHT, STEEL, BLUE, RED, OIL = "#222222", "#888888", "#f0f0f0", "#d5dde5", "#0072b2", "#d55e00", "#bfe3f2"
Point = tuple[float, float]   # (x, y): up, to the right


def keys_of(case: str) -> dict[str, list[float]]:
    """Numbers of a case file by group.key; of two groups of one name the later one has its place in front."""
    found: dict[str, list[float]] = {}
    text = re.sub(r"!.*", "", (TOP / "cases" / case).read_text(encoding="utf-8"))
    for group, body in re.findall(r"^&(\w+)(.*?)^/", text, re.MULTILINE | re.DOTALL):
        place = re.search(r"place\s*=\s*'(\w+)'", body)
        for key, values in re.findall(r"(\w+)\s*=\s*([-+\d.eE, *]+)", body):
            numbers = [float(one) for one in re.findall(r"[-+]?\d[\d.]*(?:[eE][-+]?\d+)?", values.split("*")[-1])]
            found[f"{place[1]}.{group}.{key}" if place else f"{group}.{key}"] = numbers
    return found


def rod_end(crank: float, rod: float, q: float, beside: Point = (0, 0)) -> tuple[Point, float, Point]:
    """Crank pin, rod angle and piston bearing of a mechanism whose piston pin is `beside` the centre of its bearing."""
    tilt = asin((crank * sin(q) - beside[1]) / rod)
    return (crank * cos(q), crank * sin(q)), tilt, (crank * cos(q) + rod * cos(tilt) - beside[0], 0.0)


class Drawing:
    """A drawing in SVG, of `width` by `height` points; (x, y) are lengths times `scale` from `origin`, x up."""

    def __init__(self, width: int, height: int, origin: Point, scale: float = 1) -> None:
        self.size, self.origin, self.scale, self.parts = (width, height), origin, scale, []

    def at(self, p: Point) -> Point:
        return self.origin[0] + self.scale * p[1], self.origin[1] - self.scale * p[0]

    def add(self, tag: str, text: str = "", **attributes: object) -> None:
        values = "".join(f' {name.replace("_", "-")}="{value:.2f}"' if isinstance(value, float) else f' {name.replace("_", "-")}="{value}"'
                         for name, value in attributes.items())
        self.parts.append(f"<{tag}{values}>{text}</{tag}>" if text else f"<{tag}{values}/>")

    def lines(self, *points: Point, stroke: str = INK, width: float = 1.2, fill: str = "none", dash: str = "", close: bool = False) -> None:
        path = "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in map(self.at, points)) + ("Z" if close else "")
        self.add("path", d=path, fill=fill, stroke=stroke, stroke_width=width, **({"stroke_dasharray": dash} if dash else {}))

    def circle(self, p: Point, radius: float, fill: str = "none", stroke: str = INK, width: float = 1.2, dash: str = "") -> None:
        x, y = self.at(p)
        self.add("circle", cx=x, cy=y, r=radius * self.scale, fill=fill, stroke=stroke, stroke_width=width, **({"stroke_dasharray": dash} if dash else {}))

    def bar(self, a: Point, b: Point, half: float, fill: str = STEEL) -> None:
        """A link with round ends."""
        (ax, ay), (bx, by) = self.at(a), self.at(b)
        for colour, width in ((INK, 2 * half * self.scale + 2.4), (fill, 2 * half * self.scale)):
            self.add("line", x1=ax, y1=ay, x2=bx, y2=by, stroke=colour, stroke_width=width, stroke_linecap="round")

    def arrow(self, a: Point, b: Point, stroke: str = INK, width: float = 1.4, both: bool = False) -> None:
        self.lines(a, b, stroke=stroke, width=width)
        self.head(b, atan2(b[1] - a[1], b[0] - a[0]), stroke)
        if both:
            self.head(a, atan2(a[1] - b[1], a[0] - b[0]), stroke)

    def head(self, tip: Point, direction: float, fill: str) -> None:
        long, half = 9 / self.scale, 3.2 / self.scale
        back = (tip[0] - long * cos(direction), tip[1] - long * sin(direction))
        aside = (-half * sin(direction), half * cos(direction))
        self.lines(tip, (back[0] + aside[0], back[1] + aside[1]), (back[0] - aside[0], back[1] - aside[1]), stroke="none", fill=fill, close=True)

    def turn(self, centre: Point, radius: float, a: float, b: float, stroke: str = INK, width: float = 1.2, head: bool = True) -> None:
        """An arc from the angle a to the angle b, from x to y."""
        n = max(8, int(abs(degrees(b - a)) / 4))
        points = [(centre[0] + radius * cos(a + (b - a) * i / n), centre[1] + radius * sin(a + (b - a) * i / n)) for i in range(n + 1)]
        self.lines(*points, stroke=stroke, width=width)
        if head:
            self.head(points[-1], atan2(points[-1][1] - points[-2][1], points[-1][0] - points[-2][0]), stroke)

    def text(self, p: Point, words: str, colour: str = INK, anchor: str = "middle", size: int = 15, dx: float = 0, dy: float = 5) -> None:
        """Words; `$A_b$` is a symbol with an index."""
        x, y = self.at(p)
        spans = ""
        for i, part in enumerate(words.split("$")):
            if i % 2 == 0:
                spans += f'<tspan font-family="sans-serif" font-size="{size - 3}">{html.escape(part)}</tspan>' if part else ""
                continue
            name, _, index = part.partition("_")
            spans += f'<tspan font-style="{"normal" if name.isdigit() else "italic"}">{html.escape(name)}</tspan>'
            spans += f'<tspan font-size="{size - 5}" baseline-shift="sub">{html.escape(index)}</tspan>' if index else ""
        self.add("text", spans, x=x + dx, y=y + dy, fill=colour, text_anchor=anchor, font_size=size, font_family="STIX Two Math, Times, serif")

    def axes(self, p: Point, long: float) -> None:
        self.arrow(p, (p[0] + long, p[1]), GREY)
        self.arrow(p, (p[0], p[1] + long), GREY)
        self.text((p[0] + long, p[1]), "$x$", GREY, dx=-9)
        self.text((p[0], p[1] + long), "$y$", GREY, dy=15)

    def hatch(self, a: Point, b: Point, side: float) -> None:
        """A wall from a to b with its hatching on one side: positive to the left of the way from a to b."""
        self.lines(a, b, width=1.8)
        length = hypot(b[0] - a[0], b[1] - a[1])
        along = ((b[0] - a[0]) / length, (b[1] - a[1]) / length)
        step = 8 / self.scale
        for i in range(int(length / step)):
            p = (a[0] + (i + 0.5) * step * along[0], a[1] + (i + 0.5) * step * along[1])
            aside = side * step * 0.9
            self.lines(p, (p[0] + aside * along[1] - 0.5 * step * along[0], p[1] - aside * along[0] - 0.5 * step * along[1]), stroke=GREY, width=0.8)

    def svg(self, title: str) -> str:
        width, height = self.size
        body = "\n".join(self.parts)
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}">\n<title>{title}</title>\n'
                f'<rect width="{width}" height="{height}" fill="#ffffff"/>\n{body}\n</svg>\n')


def along(a: Point, b: Point, share: float, aside: float = 0) -> Point:
    """The point at a share of the way from a to b, and `aside` of it to the right-hand side."""
    length = hypot(b[0] - a[0], b[1] - a[1])
    n = (-(b[1] - a[1]) / length, (b[0] - a[0]) / length)
    return a[0] + share * (b[0] - a[0]) + aside * n[0], a[1] + share * (b[1] - a[1]) + aside * n[1]


def mechanism() -> str:
    keys = keys_of("joints/both_pins.nml")
    crank, rod = keys["mechanism.crank_length"][0], keys["mechanism.rod_length"][0]
    q = radians(55)
    pin, tilt, piston = rod_end(crank, rod, q)
    d = Drawing(560, 660, (250, 500), 2600)
    half = 0.022
    for side in (-1, 1):
        d.hatch((0.075, side * half), (0.186, side * half), side)
    d.lines((-0.058, 0), (0.2, 0), stroke=GREY, dash="7 4", width=1)
    d.lines((piston[0] - 0.016, -half + 0.001), (piston[0] + 0.022, -half + 0.001), (piston[0] + 0.022, half - 0.001), (piston[0] - 0.016, half - 0.001),
            close=True, fill=LIGHT)
    d.turn((0, 0), crank, -pi, pi, GREY, 0.7, head=False)
    d.bar((0, 0), pin, 0.008)
    d.bar(pin, piston, 0.005)
    for centre, radius in (((0, 0), 0.006), (pin, 0.006), (piston, 0.006)):
        d.circle(centre, radius, "#ffffff")
        d.circle(centre, 0.0008, INK)
    com_crank = keys["mechanism.crank_com"]
    com_rod = keys["mechanism.rod_com"]
    for base, toward, (u, v), name in (((0, 0), pin, com_crank, "$G_c$"), (pin, piston, com_rod, "$G_r$")):
        length = hypot(toward[0] - base[0], toward[1] - base[1])
        g = along(base, toward, u / length, v)
        d.circle(g, 0.0022, INK)
        d.text(g, name, dx=15, dy=18)
    d.text(along((0, 0), pin, 0.8), "$R$", dx=2, dy=34)
    d.text(along(pin, piston, 0.3), "$L$", dx=24)
    d.turn((0, 0), 0.021, 0, q, BLUE)
    d.text((0.021 * cos(q / 2), 0.021 * sin(q / 2)), "$q$", BLUE, dx=6, dy=-8)
    d.lines(piston, (piston[0] - 0.075, 0), stroke=GREY, width=0.6)
    d.turn(piston, 0.055, pi, pi - tilt, BLUE)
    d.text((piston[0] - 0.055 * cos(tilt / 2), 0.055 * sin(tilt / 2)), "$A$", BLUE, dx=-4, dy=22)
    d.arrow((0, -0.064), (piston[0], -0.064), BLUE)
    d.lines((0, -0.002), (0, -0.068), stroke=GREY, width=0.6)
    d.lines((piston[0], -0.007), (piston[0], -0.068), stroke=GREY, width=0.6)
    d.text((piston[0] / 2, -0.064), "$x$", BLUE, dx=-12)
    d.arrow((piston[0] + 0.047, 0), (piston[0] + 0.024, 0), RED, 2)
    d.text((piston[0] + 0.044, 0), "$F_g$", RED, dx=20)
    d.axes((-0.05, 0.072), 0.024)
    d.turn((-0.05, 0.072), 0.012, 0.15, pi / 2 - 0.15, GREY)
    d.text((piston[0] + 0.006, half), "piston, $m_p$", anchor="start", dx=16)
    d.text((0.115, half), "guide", anchor="start", dx=16)
    d.text(pin, "crank pin", anchor="start", dx=24, dy=2)
    d.text(piston, "piston pin", anchor="end", dx=-64)
    d.text((0, 0), "main bearing", anchor="end", dx=-24, dy=20)
    return d.svg("Mechanism, axes and angles")


def joint() -> str:
    """The clearance is drawn a quarter of the bearing's radius."""
    radius, clearance = 150.0, 38.0
    direction, share = radians(118), 0.66
    e = (share * clearance * cos(direction), share * clearance * sin(direction))
    n = (cos(direction), sin(direction))
    t = (-n[1], n[0])
    d = Drawing(700, 470, (220, 240))
    d.circle((0, 0), radius + 22, LIGHT, GREY, 0.8)
    d.circle((0, 0), radius, OIL, INK, 1.8)
    d.circle(e, radius - clearance, STEEL, INK, 1.6)
    d.lines((0, 0), (1.05 * radius * n[0], 1.05 * radius * n[1]), stroke=GREY, dash="6 4", width=1)
    d.lines((0, 0), (105, 0), stroke=GREY, width=0.7)
    d.circle((0, 0), 2.5, INK)
    d.circle(e, 2.5, INK)
    d.arrow((0, 0), e, BLUE, 2.2)
    d.text(e, "$e$", BLUE, dx=-4, dy=19)
    d.turn((0, 0), 82, 0, direction, BLUE)
    d.text((82 * cos(direction / 2), 82 * sin(direction / 2)), "$φ$", BLUE, dx=12)
    edge = (radius * n[0], radius * n[1])
    foot = (e[0] + (radius - clearance) * n[0], e[1] + (radius - clearance) * n[1])
    d.arrow(edge, (edge[0] + 52 * n[0], edge[1] + 52 * n[1]), INK, 1.6)
    d.text((edge[0] + 52 * n[0], edge[1] + 52 * n[1]), "$n$", dx=12, dy=12)
    d.arrow(edge, (edge[0] + 52 * t[0], edge[1] + 52 * t[1]), INK, 1.6)
    d.text((edge[0] + 52 * t[0], edge[1] + 52 * t[1]), "$t$", dx=2, dy=20)
    d.lines(foot, edge, stroke=RED, width=3)
    d.text(((foot[0] + edge[0]) / 2, (foot[1] + edge[1]) / 2), "$h$", RED, dx=-6, dy=-8)
    d.turn(e, 60, radians(-30), radians(-100), BLUE)
    d.text((e[0] + 60 * cos(radians(-65)), e[1] + 60 * sin(radians(-65))), "$Ȧ$", BLUE, dx=20, dy=8)
    d.text((e[0] - 78, e[1] - 20), "pin", size=16)
    d.text((radius + 10, -60), "bearing", size=16, dx=-30)
    d.axes((-190, -195), 46)
    x = 420.0
    rows = (("$e$", "pin centre less bearing centre"), ("$c$", "radial clearance: bearing radius less pin radius"), ("$h = c − |e|$", "smallest film thickness here"),
            ("$δ = −h$", "penetration, where it is positive"), ("$n = e/|e|$", "towards the thinnest film or the contact"), ("$t$", "n turned from x to y by 90°"))
    for i, (symbol, meaning) in enumerate(rows):
        y = 150 - 40 * i
        d.text((y, 0), symbol, anchor="start", dx=x - 220 + 12)
        d.text((y - 18, 0), meaning, anchor="start", dx=x - 220 + 12, size=14)
    return d.svg("A joint with clearance")


def forces() -> str:
    keys = keys_of("joints/both_pins.nml")
    crank, rod = keys["mechanism.crank_length"][0], keys["mechanism.rod_length"][0]
    q = radians(50)
    pin, _, piston = rod_end(crank, rod, q)
    d = Drawing(720, 560, (150, 460), 2200)
    apart = 0.1   # the bodies are drawn side by side

    def moved(p: Point, column: int) -> Point:
        return p[0], p[1] + column * apart

    a, b = moved((0, 0), 0), moved(pin, 0)
    d.bar(a, b, 0.007)
    for p in (a, b):
        d.circle(p, 0.005, "#ffffff")
    long = 0.034
    d.arrow((a[0] - long - 0.006, a[1]), (a[0] - 0.006, a[1]), RED, 2)
    d.text((a[0] - long, a[1]), "$F_1$", RED, dx=16)
    d.arrow((a[0], a[1] - long - 0.006), (a[0], a[1] - 0.006), RED, 2)
    d.text((a[0], a[1] - long), "$F_2$", RED, dx=-2, dy=20)
    d.arrow((b[0] + long + 0.006, b[1]), (b[0] + 0.006, b[1]), RED, 2)
    d.text((b[0] + long, b[1]), "$F_3$", RED, dx=-16)
    d.arrow((b[0], b[1] + long), (b[0], b[1] + 0.006), RED, 2)
    d.text((b[0], b[1] + long), "$F_4$", RED, dy=20)
    d.turn(a, 0.018, radians(-150), radians(-60), BLUE, 1.8)
    d.text(a, "$τ$", BLUE, dx=-38, dy=-30)
    d.text((-0.032, 0.03), "crank", size=16)
    a, b = moved(pin, 1), moved(piston, 1)
    d.bar(a, b, 0.005)
    for p in (a, b):
        d.circle(p, 0.005, "#ffffff")
    d.arrow((a[0] - long - 0.006, a[1]), (a[0] - 0.006, a[1]), RED, 2)
    d.text((a[0] - long, a[1]), "$F_3$", RED, dx=16)
    d.arrow((a[0], a[1] - long - 0.006), (a[0], a[1] - 0.006), RED, 2)
    d.text((a[0], a[1] - long), "$F_4$", RED, dy=-8)
    d.arrow((b[0] + 0.006, b[1]), (b[0] + long + 0.006, b[1]), RED, 2)
    d.text((b[0] + long, b[1]), "$F_x$", RED, dx=16)
    d.arrow((b[0], b[1] + 0.006), (b[0], b[1] + long), RED, 2)
    d.text((b[0], b[1] + long), "$F_y$", RED, dy=-8)
    d.turn(b, 0.017, radians(200), radians(285), BLUE, 1.8)
    d.text(b, "$M$", BLUE, dx=-44, dy=24)
    d.text((0.001, pin[1] + apart), "rod, with the pin", size=16, dy=70)
    b = moved(piston, 2)
    half = 0.02
    d.lines((b[0] - 0.014, b[1] - half), (b[0] + 0.02, b[1] - half), (b[0] + 0.02, b[1] + half), (b[0] - 0.014, b[1] + half), close=True, fill=LIGHT)
    d.circle(b, 0.006, "#ffffff")
    d.arrow(b, (b[0] - long - 0.006, b[1]), RED, 2)
    d.text((b[0] - long, b[1]), "$F_x$", RED, dx=16, dy=4)
    d.arrow(b, (b[0], b[1] - long - 0.012), RED, 2)
    d.text((b[0], b[1] - long - 0.006), "$F_y$", RED, dy=-8)
    d.arrow((b[0] + 0.052, b[1]), (b[0] + 0.022, b[1]), RED, 2)
    d.text((b[0] + 0.046, b[1]), "$F_g$", RED, dx=18)
    d.arrow((b[0], b[1] + half + 0.034), (b[0], b[1] + half + 0.002), RED, 2)
    d.text((b[0], b[1] + half + 0.02), "$F_7$", RED, dy=-8)
    d.text((b[0] - 0.055, b[1]), "piston", size=16, dy=20)
    d.axes((0.0, 0.215), 0.024)
    return d.svg("Forces and moments on crank, rod and piston")


def skirt() -> str:
    keys = keys_of("joints/piston_slap.nml")
    top, bottom, radius = (keys[f"guide.{name}"][0] for name in ("skirt_top", "skirt_bottom", "piston_radius"))
    com_x, com_y = keys["guide.piston_com"]
    gap = 12 * keys["guide.bore_clearance"][0]   # gaps are drawn larger
    tilt, aside = radians(4), 0.0006
    d = Drawing(640, 480, (250, 250), 7600)
    for side in (-1, 1):
        d.hatch((-bottom - 0.006, side * (radius + gap)), (top + 0.009, side * (radius + gap)), side)
    d.lines((-bottom - 0.008, 0), (top + 0.012, 0), stroke=GREY, dash="7 4", width=1)
    pin = (0.0, aside - com_x * tilt - com_y)

    def on(u: float, v: float) -> Point:
        """A point of the piston, u along it from the pin and v across it from its axis."""
        axis = pin[1] + com_y
        return u * cos(tilt) - v * sin(tilt), axis + u * sin(tilt) + v * cos(tilt)

    corners = [on(top, radius), on(-bottom, radius), on(top, -radius), on(-bottom, -radius)]
    d.lines(corners[0], corners[1], corners[3], corners[2], close=True, fill=LIGHT)
    d.lines(on(-bottom - 0.004, 0), on(top + 0.01, 0), stroke=BLUE, width=1, dash="7 4")
    d.circle(on(0, -com_y), 0.005, "#ffffff")
    d.circle(on(0, -com_y), 0.0004, INK)
    d.circle(on(com_x, 0), 0.0005, INK)
    d.text(on(com_x, 0), "$G_p$", dx=16, dy=-4)
    for number, (p, inner) in enumerate(zip(corners, (-1, -1, 1, 1)), 1):
        d.circle(p, 0.0006, RED, RED)
        d.text(p, f"${number}$", RED, dx=14 * inner, dy=18 if number % 2 else -8, size=17)
    d.text(on(0, -com_y), "pin", dx=-30, dy=30)
    d.turn(on(-bottom, 0), bottom + top + 0.007, 0, tilt, BLUE)
    d.text((top + 0.0085, 0.0014), "tilt", BLUE, anchor="start", dx=16)
    x = radius + gap + 0.0035
    d.arrow((0, x), (top, x), BLUE, both=True)
    d.arrow((0, x), (-bottom, x), BLUE, both=True)
    d.text((top / 2, x), "skirt_top", BLUE, anchor="start", dx=8)
    d.text((-bottom / 2, x), "skirt_bottom", BLUE, anchor="start", dx=8)
    d.arrow((-bottom - 0.004, on(-bottom, 0)[1]), (-bottom - 0.004, on(-bottom, radius)[1]), BLUE, both=True)
    d.text((-bottom - 0.004, 0.011), "piston_radius", BLUE, dy=18)
    d.axes((top + 0.004, x + 0.012), 0.006)
    return d.svg("Corners of the skirt, pin offset and tilt")


def skirt_film() -> str:
    """Gaps of the case joints/skirt, drawn larger than the piston; one of its faces unrolled, with the grid of the film."""
    keys = keys_of("joints/skirt.nml")
    angle = 45.0   # half_angle_deg, its default
    top, bottom, clearance, barrel = (keys[f"guide.{name}"][0] for name in ("skirt_top", "skirt_bottom", "bore_clearance", "barrel"))
    d = Drawing(790, 370, (225, 135), 4.6)
    radius, wide, tilt, aside = 24.0, 0.26, radians(-1.9), -2.2   # of points: the gaps are 260 times as wide as long
    middle, half = (top - bottom) / 2, (top + bottom) / 2

    def face(side: int, z: float) -> Point:
        return z, aside + z * tilt + side * (radius - wide * barrel * ((z - middle) / half) ** 2)

    wall = radius + wide * clearance
    heights = [middle + half * (i / 12 - 1) for i in range(25)]
    for side in (-1, 1):
        d.lines(*[face(side, z) for z in heights], (top, side * wall), (-bottom, side * wall), close=True, fill=OIL, stroke="none")
        d.hatch((-bottom - 7, side * wall), (top + 9, side * wall), -side)
    d.lines(*[face(1, z) for z in heights], *[face(-1, z) for z in reversed(heights)], close=True, fill=LIGHT)
    d.lines((-bottom - 7, 0), (top + 12, 0), stroke=GREY, dash="7 4", width=1)
    d.lines((-bottom - 4, aside - (bottom + 4) * tilt), (top + 9, aside + (top + 9) * tilt), stroke=BLUE, dash="7 4", width=1)
    pressed = [face(-1, z) for z in heights]
    d.lines(*[(z, y + 9.0 * max(0.0, sin(pi * (z - middle + half) / (1.15 * half))) ** 1.5) for z, y in pressed], stroke=RED, width=2)
    d.text((middle - 0.35 * half, aside - radius + 11), "$p$", RED, anchor="start", dx=14)
    d.circle((-6, aside - 6 * tilt), 0.6, INK)
    d.text((-6, aside - 6 * tilt), "$G_p$", dx=16)
    d.text((top + 8, aside + (top + 8) * tilt), "$b$", BLUE, dx=16, dy=-2)
    d.text((-bottom - 5, 0.5 * aside), "$y$", BLUE, dy=16)
    for z, name in ((top, "$z_t$"), (-bottom, "$z_b$")):
        d.text((z, wall), name, anchor="start", dx=16)
    d.text((middle, wall), "$h(z, φ)$", anchor="start", dx=16)
    d.arrow((middle, wall + 3), (middle, wall - 4), width=1)
    d.text((top + 7, -wall), "side −1", size=14, anchor="end", dx=-14)
    d.text((top + 7, wall), "side +1", size=14, anchor="start", dx=14)
    left, across = 62.0, 46.0
    steps = [middle + half * (0.4 * t + 0.6 * sin(pi * t / 2)) for t in (-1 + i / 12 for i in range(25))]
    d.lines((-bottom, left), (top, left), (top, left + across), (-bottom, left + across), close=True, fill=OIL)
    for z in steps:
        d.lines((z, left), (z, left + across), stroke=GREY, width=0.5)
    for i in range(1, 12):
        d.lines((-bottom, left + across * i / 12), (top, left + across * i / 12), stroke=GREY, width=0.5)
    d.lines((-bottom - 4, left + across / 2), (top + 4, left + across / 2), stroke=INK, dash="7 4", width=1)
    d.text((top + 4, left + across / 2), "thrust axis, $φ = 0$", dy=-6)
    d.text((-bottom, left), f"$−{angle:.0f}°$", dy=20)
    d.text((-bottom, left + across), f"${angle:.0f}°$", dy=20)
    d.arrow((-bottom - 9, left + across / 2), (-bottom - 9, left + across), BLUE)
    d.text((-bottom - 9, left + 0.75 * across), "half_angle_deg", BLUE, size=14, dy=18)
    d.text((middle, left + across), "$p = 0$", RED, anchor="start", dx=8)
    d.axes((-bottom - 9, wall + 13), 7)
    return d.svg("Gaps between skirt and bore, and the film on one face")


def skirt_springs() -> str:
    """An elastic face on the side of +y: a panel on springs at its ends, which its film presses towards the piston."""
    keys = keys_of("joints/skirt.nml")
    top, bottom = (keys[f"guide.{name}"][0] for name in ("skirt_top", "skirt_bottom"))
    d = Drawing(430, 330, (60, 120), 4.6)
    body, free, wall = 14.0, 40.0, 52.0
    bent = {top: 4.0, -bottom: 9.0}   # deflections of the ends
    d.lines((top, 0), (top, body), (-bottom, body), (-bottom, 0), fill=LIGHT)
    face = [(z, free - w) for z, w in bent.items()]
    d.lines(*face, (-bottom, wall), (top, wall), close=True, fill=OIL, stroke="none")
    d.lines((top, free), (-bottom, free), stroke=GREY, dash="7 4", width=1)
    d.lines(*face, width=3)
    d.hatch((-bottom - 5, wall), (top + 6, wall), -1)
    for z, w in bent.items():
        z += -3 if z > 0 else 3   # the springs are drawn a little inside the ends
        end = free - w - 2
        turns = [(z + (1.6 if k % 2 else -1.6), body + 2 + (end - body - 4) * (k + 0.5) / 8) for k in range(8)]
        d.lines((z, body), (z, body + 2), *turns, (z, end), (z, free - w), width=1.4)
        d.text((z, body + 6), "$K$", BLUE, dy=24)
    for z, w, name in ((top, bent[top], "$ζ_t$"), (-bottom, bent[-bottom], "$ζ_b$")):
        out = 3 if z > 0 else -3
        d.lines((z, free), (z + 2 * out, free), stroke=GREY, width=0.8)
        d.lines((z, free - w), (z + 2 * out, free - w), stroke=GREY, width=0.8)
        d.arrow((z + 1.3 * out, free), (z + 1.3 * out, free - w), BLUE)
        d.text((z + 2 * out, free - w / 2), name, BLUE, dy=2 if z > 0 else 14)
    for k in range(1, 6):
        z = -bottom + (top + bottom) * k / 6
        d.arrow((z, wall - 1), (z, wall - 1 - 6 * sin(pi * k / 6)), RED, width=1)
    d.text(((top - bottom) / 2, wall), "$p$", RED, anchor="start", dx=10)
    d.text(((top - bottom) / 2, body / 2), "piston", size=14)
    d.text((top, wall), "$z_t$", anchor="start", dx=14)
    d.text((-bottom, wall), "$z_b$", anchor="start", dx=14)
    d.axes((-bottom - 2, wall + 12), 7)
    return d.svg("A face of the skirt on its two springs")


def ring_film() -> str:
    """Rings of the case joints/piston in their grooves; the face of the last one, with its crown 25 times as wide as it is, and its film."""
    keys = keys_of("joints/piston.nml")
    height, crown = keys["ring.height"][0], keys["ring.crown"][0]
    d = Drawing(790, 390, (30, 200), 1)
    wall, land, deep = 190.0, 172.0, 34.0   # points
    grooves = (105, 65, 25)
    outline = [(140, 30), (140, land)]
    for middle in grooves:
        outline += [(middle + 7, land), (middle + 7, land - deep), (middle - 7, land - deep), (middle - 7, land)]
    d.lines(*outline, (-20, land), (-30, wall - 9), (-80, wall - 4), (-140, wall - 9), (-140, 30), fill=STEEL)
    for number, middle in enumerate(grooves, start=1):
        d.lines((middle + 4, land - deep + 8), (middle + 4, wall - 3), (middle - 1.5, wall), (middle - 7, wall - 3), (middle - 7, land - deep + 8), close=True, fill=LIGHT)
        d.text((middle, land - deep), f"$ {number}$", dx=-12)
    d.hatch((-160, wall), (165, wall), -1)
    d.lines((-160, 30), (165, 30), stroke=GREY, dash="7 4", width=1)
    d.text((160, 110), "gas")
    d.text((-80, 110), "skirt")
    d.text((-162, 110), "crankcase")
    wall, long = 640.0, 230.0
    wide, least = 25e-3 * long / height, 16.0   # crown in um, height in mm
    top, bottom = long / 2, -long / 2
    peak = 0.18   # of the crown, of half the height: crown_offset upwards

    def face(share: float) -> Point:
        return share * top, wall - least - wide * crown * (share - peak) ** 2

    shares = [i / 24 - 1 for i in range(49)]
    d.lines(*[face(s) for s in shares], (top, wall), (bottom, wall), close=True, fill=OIL, stroke="none")
    d.lines(*[face(s) for s in shares], (top, 430), (bottom, 430), close=True, fill=LIGHT)
    d.hatch((bottom - 50, wall), (top + 50, wall), -1)
    d.lines(*[(s * top, wall + 18 + 62 * max(0.0, sin(pi * (s + 0.12) / 1.12)) ** 1.6) for s in shares if s >= -0.12], stroke=RED, width=2)
    d.text((0.55 * top, wall + 95), "$p$", RED)
    d.lines((peak * top, wall - 150), (peak * top, wall), stroke=GREY, dash="7 4", width=1)
    d.lines((0, 430), (0, 540), stroke=GREY, dash="7 4", width=1)
    d.arrow((0, 505), (peak * top, 505), width=1)
    d.text((peak * top / 2, 505), "$x_0$", dx=-14)
    d.arrow((peak * top, wall - least - 30), (peak * top, wall - least), width=1)
    d.text((peak * top, wall - least - 38), "$h_r$", dy=-6)
    d.arrow((bottom, 446), (top, 446), width=1, both=True)
    d.text((-0.45 * top, 446), "$b$", dx=12)
    low, crest = face(peak - 1), wall - least
    d.lines((peak * top, crest), (bottom, crest), stroke=GREY, dash="3 3", width=1)
    d.arrow(low, (low[0], crest), width=1, both=True)
    d.text((low[0], (low[1] + crest) / 2), "$a$", dy=-5)
    for x, name, y in ((top + 26, "$g_above$", 540), (bottom - 26, "$g_below$", 500), (0, "$g_behind$", 378)):
        d.text((x, y), name, RED)
    d.arrow((0.45 * top, 385), (0.45 * top, 428), BLUE)
    d.text((0.45 * top, 380), "$W′$", BLUE, anchor="end")
    d.arrow((top + 8, 470), (top + 44, 470), BLUE)
    d.text((top + 44, 470), "$U$", BLUE, dx=14)
    d.axes((bottom - 45, 385), 34)
    return d.svg("Rings in their grooves, and the film on the face of one")


def offset_axis() -> str:
    """The offset is drawn larger, the same crank and rod at both dead centres."""
    keys = keys_of("drive/offset_crank.nml")
    crank, rod = (keys[f"mechanism.{name}"][0] for name in ("crank_length", "rod_length"))
    axis = 3.5 * keys["mechanism.axis_offset"][0]
    d = Drawing(560, 640, (240, 480), 3.6)
    half = 17.0
    for side in (-1, 1):
        d.hatch((40, axis + side * half), (126, axis + side * half), -side)
    d.lines((-34, axis), (128, axis), stroke=GREY, dash="7 4", width=1)
    d.lines((-34, 0), (128, 0), stroke=GREY, dash="2 4", width=1)
    d.turn((0, 0), crank, -pi, pi, GREY, 0.7, head=False)
    top, bottom = asin(axis / (rod + crank)), pi + asin(axis / (rod - crank))
    for q, name, beside in ((top, "$q_t$", 10), (bottom, "$q_b$", -14)):
        pin, _, piston = rod_end(crank, rod, q, (0, axis))
        piston = (piston[0], axis)
        d.lines((0, 0), pin, piston, stroke=BLUE, width=1, dash="7 4")
        d.circle(piston, 1.4, "#ffffff", BLUE)
        d.text(pin, name, BLUE, dx=beside, dy=-8 if q < 1 else 16)
    q = radians(62)
    pin, _, piston = rod_end(crank, rod, q, (0, axis))
    piston = (piston[0], axis)
    d.lines((piston[0] - 11, axis - half + 1), (piston[0] + 15, axis - half + 1), (piston[0] + 15, axis + half - 1), (piston[0] - 11, axis + half - 1),
            close=True, fill=LIGHT)
    d.bar((0, 0), pin, 5)
    d.bar(pin, piston, 3.2)
    for centre in ((0, 0), pin, piston):
        d.circle(centre, 3.8, "#ffffff")
    d.turn((0, 0), 12.5, 0, q, BLUE)
    d.text((12.5 * cos(q / 2), 12.5 * sin(q / 2)), "$q$", BLUE, dx=9, dy=-6)
    d.arrow((-30, 0), (-30, axis), RED, both=True)
    d.text((-30, axis), "axis_offset $d$", RED, anchor="start", dx=10)
    d.arrow((rod_height(crank, rod, axis, bottom), axis - half - 9), (rod_height(crank, rod, axis, top), axis - half - 9), BLUE, both=True)
    d.text((84, axis - half - 9), "stroke", BLUE, anchor="end", dx=-8)
    d.axes((-24, -50), 15)
    return d.svg("A cylinder axis beside the crank axis, and its dead centres")


def rod_height(crank: float, rod: float, axis: float, q: float) -> float:
    return rod_end(crank, rod, q, (0, axis))[2][0]


def floating_pin() -> str:
    radius = 60.0
    piston_radius, rod_radius = radius + 16, radius + 30
    e_b, e_s = (11.0, 9.0), (-17.0, 18.0)   # pin from the centres of the bearings in the piston and in the rod
    d = Drawing(680, 330, (150, 175))
    pin = (0.0, 0.0)
    for middle, centre, hole, name, colour, index in ((0, (pin[0] - e_b[0], pin[1] - e_b[1]), piston_radius, "bearing in the piston", LIGHT, "b"),
                                                       (330, (pin[0] - e_s[0], pin[1] - e_s[1]), rod_radius, "bearing in the small end", STEEL, "s")):
        p = (pin[0], pin[1] + middle)
        c = (centre[0], centre[1] + middle)
        d.circle(c, hole + 26, colour, INK)
        d.circle(c, hole, OIL, INK, 1.6)
        d.circle(p, radius, "#fdfdfd", INK, 1.4)
        d.arrow(c, p, BLUE, 1.8)
        d.circle(c, 2.2, INK)
        d.circle(p, 2.2, INK)
        d.text(c, f"$O_{index}$", dx=-12, dy=12 if index == "b" else -4)
        d.text(p, "$O_g$", dx=14, dy=-6)
        d.text(((c[0] + p[0]) / 2, (c[1] + p[1]) / 2), f"$e_{index}$", BLUE, dx=14 if index == "b" else -14, dy=14 if index == "b" else 16)
        d.text((-hole - 48, c[1]), name)
    d.turn(pin, 44, radians(150), radians(235), BLUE)
    d.text((44 * cos(radians(190)), 44 * sin(radians(190))), "pin_speed", BLUE, dx=-2, dy=16, size=14)
    d.axes((-110, 470), 40)
    return d.svg("A floating pin in its two bearings")


def crank_train() -> str:
    d = Drawing(800, 380, (60, 250))
    stations, apart = 4, 130.0
    for i in range(stations):
        y = i * apart
        if i:
            d.lines(*[(8 * (0, 1, -1, 1, -1, 0)[k], y - apart + 26 + (apart - 52) * k / 5) for k in range(6)])
            d.text((28, y - apart / 2), f"$k_{i}$")
        last = i == stations - 1
        d.lines((-42, y - 26), (42, y - 26), (42, y + 26), (-42, y + 26), close=True, fill=STEEL)
        d.text((0, y), f"$J_{'S' if last else i + 1}$", size=18)
        d.text((-64, y), "flywheel, drive" if last else f"station {i + 1}", size=14)
    for i, name in ((1, "cylinder 1"), (2, "cylinder 2, full")):
        y = i * apart
        d.bar((44, y), (118, y - 14 if i == 1 else y + 14), 5)
        d.lines((118, y - 32), (158, y - 32), (158, y + 32), (118, y + 32), close=True, fill=LIGHT)
        d.text((176, y), name, size=14)
    d.lines((44, 0), (88, 0), width=1, dash="4 3")
    d.circle((112, 0), 24, OIL)
    d.text((150, 0), "ring of a damper", size=14)
    d.text((-98, 0), "front", GREY, size=14)
    d.text((-98, 3 * apart), "rear", GREY, size=14)
    c = (50.0, 550.0)
    d.circle(c, 66, LIGHT, GREY)
    d.arrow(c, (c[0] + 92, c[1]), GREY)
    d.text((c[0] + 92, c[1]), "$x$", GREY, dx=12)
    bank, phase = radians(50), radians(88)
    d.lines(c, (c[0] + 112 * cos(bank), c[1] + 112 * sin(bank)), dash="7 4", stroke=INK)
    d.text((c[0] + 112 * cos(bank), c[1] + 112 * sin(bank)), "axis of cylinder $i$", size=14, dy=-2, dx=6, anchor="start")
    d.turn(c, 84, 0, bank, BLUE)
    d.text((c[0] + 84 * cos(bank / 2), c[1] + 84 * sin(bank / 2)), "bank_deg", BLUE, size=14, anchor="start", dx=2, dy=-12)
    mark = radians(-62)
    d.lines((c[0] + 66 * cos(mark + phase) - 4, c[1] + 66 * sin(mark + phase) + 4), (c[0] + 26, c[1] + 60), stroke=GREY, width=0.7)
    for angle, name in ((mark, "mark"), (mark + phase, "throw i")):
        p = (c[0] + 66 * cos(angle), c[1] + 66 * sin(angle))
        d.lines(c, p, width=3 if name != "mark" else 1)
        d.circle(p, 5, "#ffffff")
    d.text((c[0] + 66 * cos(mark + phase), c[1] + 66 * sin(mark + phase)), "throw $i$", size=14, dx=30, dy=34, anchor="start")
    d.text((c[0] + 66 * cos(mark), c[1] + 66 * sin(mark)), "mark", size=14, dx=-24)
    d.turn(c, 40, mark, mark + phase, BLUE)
    d.text((c[0] + 40 * cos(mark + phase / 2), c[1] + 40 * sin(mark + phase / 2)), "phase_deg", BLUE, size=14, anchor="end", dx=-2, dy=-6)
    return d.svg("Stations of a crankshaft, bank and phase")


def supply() -> str:
    d = Drawing(720, 330, (170, 165))
    radius, clearance = 96.0, 20.0
    e = (clearance * 0.7 * cos(radians(150)), clearance * 0.7 * sin(radians(150)))
    d.circle((0, 0), radius + 24, LIGHT, INK)
    d.circle((0, 0), radius, OIL, INK, 1.6)
    groove, half = radians(90), radians(16)
    arc = [(r * cos(groove + s * half), r * sin(groove + s * half)) for r, order in ((radius, (-1, 0, 1)), (radius + 12, (1, 0, -1))) for s in order]
    d.lines(*arc, close=True, fill=OIL)
    d.circle(e, radius - clearance, STEEL)
    d.lines((0, 0), (radius + 40, 0), stroke=GREY, width=0.8)
    d.text((radius + 40, 0), "$x$", GREY, dx=-12)
    d.turn((0, 0), 48, 0, groove, BLUE)
    d.text((48 * cos(groove / 2), 48 * sin(groove / 2)), "position_deg", BLUE, size=14, anchor="start", dx=-12, dy=26)
    d.turn((0, 0), radius + 34, groove - half, groove + half, BLUE, head=False)
    d.text((0, radius + 34), "width_deg", BLUE, size=14, anchor="start", dx=6)
    left, wide, tall = 290.0, 230.0, 150.0
    d.lines((-tall / 2, left), (tall / 2, left), (tall / 2, left + wide), (-tall / 2, left + wide), close=True, fill=LIGHT)
    d.lines((0, left - 8), (0, left + wide + 8), stroke=GREY, dash="7 4", width=1)
    d.lines((-38, left + 50), (38, left + 50), (38, left + 78), (-38, left + 78), close=True, fill=OIL)
    d.text((-52, left + 64), "groove", size=14)
    d.circle((0, left + 160), 13, OIL)
    d.text((-30, left + 160), "hole", size=14)
    d.arrow((-38, left + 36), (38, left + 36), BLUE, both=True)
    d.text((18, left + 36), "length", BLUE, size=14, anchor="end", dx=16, dy=-28)
    d.arrow((-tall / 2, left + wide + 22), (tall / 2, left + wide + 22), BLUE, both=True)
    d.text((20, left + wide + 22), "bearing_length", BLUE, size=14, dx=-6, dy=-72, anchor="end")
    d.arrow((-tall / 2 - 22, left), (-tall / 2 - 22, left + wide), GREY)
    d.text((-tall / 2 - 40, left + wide / 2), "round the bearing, from x to y", GREY, size=14)
    return d.svg("Where oil is fed to a bearing")


def film() -> str:
    """Gap and pressure of a long film round a bearing under rotation alone (Sommerfeld), its negative half set to zero."""
    eps = 0.7
    d = Drawing(680, 300, (60, 250))
    wide = 560.0
    steps = 180
    angles = [2 * pi * i / steps for i in range(steps + 1)]
    gap = [(1 - eps * cos(a - pi)) * 70 for a in angles]
    pressure = [max(0.0, eps * sin(a) * (2 - eps * cos(a - pi) * 1.0) / (1 + eps * cos(a)) ** 2) for a in angles]
    top = max(pressure)
    d.lines((0, 0), *[(g, wide * a / (2 * pi)) for a, g in zip(angles, gap)], (0, wide), close=True, fill=OIL)
    d.lines(*[(p / top * 190, wide * a / (2 * pi)) for a, p in zip(angles, pressure)], stroke=RED, width=2)
    d.lines((0, 0), (0, wide), width=1.8)
    d.text((150, wide * 0.2), "pressure", RED)
    d.text((gap[0] / 2, 50), "$h(θ)$")
    d.text((-24, wide / 2), "thinnest film")
    d.text((-24, 0), "thickest film", anchor="start", dx=-20)
    d.text((22, wide * 0.78), "ruptured film: no pressure", size=14)
    d.arrow((205, wide * 0.75), (205, wide * 0.95), GREY)
    d.text((220, wide * 0.85), "surface of the pin", GREY, size=14)
    d.lines((0, wide / 2), (205, wide / 2), stroke=GREY, dash="5 4", width=0.9)
    return d.svg("Gap and pressure of a film, unrolled from its thickest place")


DRAWINGS = (mechanism, joint, forces, skirt, skirt_film, ring_film, skirt_springs, offset_axis, floating_pin, crank_train, supply, film)


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else TOP / "data/manual/drawings"
    for draw in DRAWINGS:
        (folder / f"{draw.__name__}.svg").write_text(draw(), encoding="utf-8")


if __name__ == "__main__":
    main()
