#!/usr/bin/env python3
"""Opens pages of gudgeon-plot report in headless Chromium: they are drawn, play, move with the time slider, zoom, and the console has
no messages.

    tests/test_report.py [PAGE.html...]     default: pages of one run of each kind, made for the test

--screenshots DIR stores pictures of the browser's pages. Needs Debian's packages chromium and chromium-driver, which
scripts/setup.sh --browser installs; without them the test fails. Ends with the line "N passed, N failed".
"""

import argparse
import base64
import json
import math
import os
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path
from types import SimpleNamespace

from assertions import Assertions

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts" / "bench"))

from measured import use_virtual_environment

use_virtual_environment()

from gudgeon.language import Language
from gudgeon.report.answers import Answers, amount, html_of, lines, losses_of, number, of_numbered, section, warnings
from gudgeon.report.explorer import answers_of, shown_unit

TOP = Path(__file__).resolve().parents[1]

#: A film without contact, a film with contacts and gas, dry contact, a piston with clearance in its bore (with clearance at the
#: pin, with ideal pins), an ideal joint, dry contact with an elastic rod, clearance at both pins, a crank pin whose film heats up,
#: numbered bearings of an engine, a shaft that twists, a piston whose last cycle begins within that of the gas, three bearings.
CASES = ("sim_I", "sim_V_oscillating", "dry_0500um", "piston_slap", "slider_clearance", "ideal", "dry_friction", "both_pins", "heat", "inline_four_bearings", "six_mwm", "piston", "car_diesel")

#: The one of them of which a copy with a long name in a folder with a long path is shown.
FAR_AWAY = "six_mwm"

#: A case made here: the measured pressure with its peak at 0, from -360 to 360 degrees, as a rig writes it.
FIRES_AT_0 = "fires_at_0"

LARGEST_PAGE = 2_000_000  # bytes

BROWSER_OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1280,1000",
)

#: For a server on this machine, whatever proxy the environment names.
DIRECT = urllib.request.build_opener(urllib.request.ProxyHandler({}))

#: Whether anything has been drawn on a canvas.
PAINTED = """const c = document.getElementById(arguments[0]), blank = document.createElement('canvas');
blank.width = c.width; blank.height = c.height; return c.toDataURL() !== blank.toDataURL();"""

#: The image on a canvas.
IMAGE = "return document.getElementById(arguments[0]).toDataURL()"

#: Chooses the abscissa of the plots, and whether the last cycle is shown alone.
CHOOSE = """for (const [id, key, value] of [['abscissa', 'value', arguments[0]], ['last-cycle', 'checked', arguments[1]]]) {
const e = document.getElementById(id); e[key] = value; e.dispatchEvent(new Event('change', {bubbles: true})); }"""

#: Moves a slider as a user would.
MOVE = """const e = document.getElementById(arguments[0]); e.value = arguments[1];
e.dispatchEvent(new Event('input', {bubbles: true})); e.dispatchEvent(new Event('change', {bubbles: true}));"""


class Browser:
    """A headless Chromium, controlled by the WebDriver protocol."""

    def __init__(self, chromium: str, driver: str, profile: str, *arguments: str) -> None:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.base = f"http://127.0.0.1:{port}"
        environment = os.environ | {"TMPDIR": "/tmp"}   # Chromium ends where the path of its socket there has more than 107 bytes
        self.process = subprocess.Popen([driver, f"--port={port}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
        self.session = ""
        options = {"binary": chromium, "args": [*BROWSER_OPTIONS, *arguments, f"--user-data-dir={profile}"]}
        capabilities = {
            "alwaysMatch": {
                "browserName": "chrome",
                "goog:chromeOptions": options,
                "goog:loggingPrefs": {"browser": "ALL"},
            }
        }
        why = ""
        for _ in range(300):
            try:
                self.session = self.call("POST", "/session", {"capabilities": capabilities})["sessionId"]
                # a headless page may have no focus, without which elements have no focus events
                self.cdp("Emulation.setFocusEmulationEnabled", enabled=True)
                return
            except (urllib.error.URLError, ConnectionError) as error:
                why = error.read().decode() if isinstance(error, urllib.error.HTTPError) else str(error)
                time.sleep(0.2)
        self.process.terminate()
        raise RuntimeError(f"chromedriver starts no browser: {why}")

    def call(self, method: str, path: str, body: dict | None = None) -> object:
        """Execute one command and return its value. Raises urllib.error.HTTPError if the browser refuses it."""
        data = None if body is None else json.dumps(body).encode()
        url = self.base + (f"/session/{self.session}" if self.session else "") + path
        request = urllib.request.Request(url, data, {"Content-Type": "application/json"}, method=method)
        with DIRECT.open(request, timeout=120) as answer:
            return json.load(answer)["value"]

    def cdp(self, command: str, **values: object) -> object:
        """Execute a command of the DevTools protocol."""
        return self.call("POST", "/goog/cdp/execute", {"cmd": command, "params": values})

    def width_at(self, width: int) -> int:
        """Show the page on a screen of this width and return the width that it takes; 0 shows it as before."""
        if width:
            self.cdp("Emulation.setDeviceMetricsOverride", width=width, height=800, deviceScaleFactor=0, mobile=True)
        else:
            self.cdp("Emulation.clearDeviceMetricsOverride")
        self.wait(f"document.documentElement.scrollWidth <= {width or 10000}", 10)   # charts follow a little later
        return self.run("return document.documentElement.scrollWidth")

    def open(self, page: Path) -> None:
        self.call("POST", "/url", {"url": page.resolve().as_uri()})

    def run(self, script: str, *values: object) -> object:
        return self.call("POST", "/execute/sync", {"script": script, "args": list(values)})

    def wait(self, condition: str, seconds: float = 60) -> bool:
        limit = time.monotonic() + seconds
        while time.monotonic() < limit:
            if self.run(f"return Boolean({condition})"):
                return True
            time.sleep(0.1)
        return False

    def messages(self) -> list[str]:
        """The warnings and errors of the console since the last call."""
        entries = self.call("POST", "/se/log", {"type": "browser"})
        return [entry["message"] for entry in entries if entry["level"] in ("SEVERE", "WARNING")]

    def printed(self) -> int:
        """Number of sheets of A4 that the page takes."""
        data = base64.b64decode(self.cdp("Page.printToPDF", paperWidth=8.27, paperHeight=11.69)["data"])
        return len(re.findall(rb"/Type\s*/Page\b", data))

    def screenshot(self, path: Path) -> None:
        path.write_bytes(base64.b64decode(self.call("GET", "/screenshot")))

    def close(self) -> None:
        try:
            if self.session:
                self.call("DELETE", "")
        except (urllib.error.URLError, ConnectionError):
            pass
        self.process.terminate()
        self.process.wait(10)


#: How a value is written on the pages, and what it has to be.
WRITTEN = """return [[130.6, 'N', '131 N'], [3.934, 'N', '3.93 N'], [5.966e-9, 'm', '5.97 nm'], [-6.322e-7, 'm', '-0.632 µm'], [1.13, 's', '1.13 s'], [999.7, 'N', '1.00 kN'],
  [25248, 'N', '25.2 kN'], [0, 'N', '0.00 N'], [3e-13, 'Pa', '0.000300 nPa'], [1.2e8, 'Pa', '120 MPa']].map(([value, unit, text]) => [amount(value, unit), text]).filter(([a, b]) => a !== b);"""


def check_state(browser: Browser, name: str, checks: Assertions) -> None:
    """The line on the moment shown: the crank angle within the cycle, true minuses, units that suit their values; a twist is named where it is drawn."""
    said = browser.run("return document.getElementById('state').textContent")
    cycle = browser.run("return gudgeon.scene.cycle")
    angle = float(said.split("crank ", 1)[1].split("°", 1)[0])
    checks.check(cycle is None or 0 <= angle < cycle["degrees"] + 0.1, f"{name}: the crank angle is within the cycle: {said}")
    checks.check(not re.search(r"\b0\.00 kN|e[+-]\d|-\d", said), f"{name}: values of the moment: {said}")
    checks.check(not (wrong := browser.run(WRITTEN)), f"{name}: values as written and as wanted: {wrong}")
    drawn = browser.run("return Boolean(gudgeon.scene.engine && gudgeon.scene.engine.largest > 0)")
    checks.check(browser.run("return document.getElementById('twist-note').hidden") != drawn, f"{name}: the twist of the shaft is named where it is drawn")


def check_page(browser: Browser, page: Path, checks: Assertions, pictures: Path | None) -> None:
    """Check one page as a reader uses it."""
    name = page.stem
    checks.check(page.stat().st_size < LARGEST_PAGE, f"{name}: {page.stat().st_size} bytes")
    text = page.read_text(encoding="utf-8")
    checks.check(
        'src="http' not in text and "{{" not in text.split("<script", 1)[0], f"{name}: loads no other file, and all fields are filled in"
    )
    browser.open(page)
    checks.check(browser.wait("window.gudgeon && window.gudgeon.ready"), f"{name}: becomes ready")
    checks.check(browser.run("return document.getElementById('failure').hidden"), f"{name}: shows no error message")
    checks.check(browser.run("return [...document.querySelectorAll('details')].every(d => !d.open) && document.querySelectorAll('#plots > div').length <= 6"), f"{name}: details are folded")
    lost = browser.run("return [...document.querySelectorAll('#contents a')].filter(a => !document.querySelector(a.hash)).map(a => a.hash)")
    checks.check(not lost and browser.run("return document.querySelectorAll('#contents a').length") >= 6, f"{name}: links of the contents lead to {lost}")
    browser.run("document.querySelector('#contents a[href=\"#case\"]').click()")
    checks.check(browser.run("return document.getElementById('case').open") and browser.wait("Math.abs(document.getElementById('contents').getBoundingClientRect().top) < 1 && window.scrollY > 100", 10),
                 f"{name}: a link unfolds its part, and the contents stay in view")
    rows = browser.run("const t = [...document.querySelectorAll('#case td:nth-child(2)')].map(d => d.textContent); document.getElementById('case').open = false; window.scrollTo(0, 0); return t")
    checks.check(len(rows) > 4 and "" not in rows and "0" not in rows and any(row.endswith("rpm") for row in rows) and any(row.endswith(" mm") for row in rows), f"{name}: keys of the case: {rows}")
    checks.check(browser.printed() <= 2, f"{name}: takes two sheets of A4, not {browser.printed()}")
    browser.run("document.querySelectorAll('details').forEach(d => { d.open = true; })")
    checks.check(browser.printed() > 2, f"{name}: unfolded details are printed")
    checks.check(browser.wait("gudgeon.charts.every(c => c.div.querySelector('svg').clientWidth <= c.div.clientWidth + 1)", 10), f"{name}: unfolded plots fit their place")
    clearance = browser.run("return gudgeon.scene.clearance > 0")
    canvases = ["mechanism", "timeline"] + (["joint", "orbit"] if clearance else [])
    canvases += ["bore"] if browser.run("return gudgeon.scene.bore !== null") else []
    canvases += ["crank-pin-orbit"] if browser.run("return gudgeon.scene.crank_pin !== null") else []
    canvases += ["main-bearing-orbit"] if browser.run("return gudgeon.scene.main_bearing !== null") else []
    plots = browser.run("return gudgeon.scene.plots.length")
    checks.check(
        plots >= 5 and browser.run("return document.querySelectorAll('.plots .main-svg').length") >= plots,
        f"{name}: every plot is drawn",
    )
    empty = browser.run(
        "return gudgeon.charts.filter(c => ![...c.div.querySelectorAll('.scatterlayer path.js-line')]"
        ".some(p => (p.getAttribute('d') || '').length > 20)).map(c => c.div.layout.title.text)"
    )
    checks.check(not empty, f"{name}: plots without a curve: {empty}")
    covered = browser.run(
        "return gudgeon.charts.filter(c => { const box = s => c.div.querySelector(s).getBoundingClientRect();"
        " return box('.gtitle').right > box('.modebar-group').left; }).map(c => c.div.layout.title.text)"
    )
    checks.check(not covered, f"{name}: titles that the tool bar covers: {covered}")

    several = [column for column in browser.run("return gudgeon.scene.columns") if column.endswith("film_thickness") and not column.startswith("ideal")]
    films = browser.run("return gudgeon.charts.filter(c => c.curves.some(u => u.y.endsWith('film_thickness'))).map(c => [c.curves.map(u => u.y), c.div.data.filter(d => d.line.dash === 'solid').map(d => d.line.color)])")
    checks.check(len(films) == bool(several) and (not films or (set(several) <= set(films[0][0]) and len(set(films[0][1])) == len(several))),
                 f"{name}: one chart of all films, with a colour for each: {films} of {several}")
    checks.check(
        browser.run("return Math.abs(gudgeon.now - gudgeon.scene.start) < 1e-9"), f"{name}: opens at the time of the largest pin force"
    )
    checks.check(
        browser.run("return [...document.querySelectorAll('.planes > div')].length") == browser.run("return gudgeon.scene.plots.filter(p => p.square).length"),
        f"{name}: plots of planes are in a separate place",
    )
    if clearance and browser.run("return gudgeon.scene.contacts.length"):
        orbit = "gudgeon.charts.find(c => c.div.layout.title.text === gudgeon.scene.plots.find(p => p.circle).title)"
        checks.check(browser.run(f"return {orbit}.div.data.length") == 2, f"{name}: the orbit marks contact")
    before = {canvas: browser.run(IMAGE, canvas) for canvas in canvases}
    browser.run(MOVE, "scrub", 0.37)
    checks.check(browser.run("return gudgeon.now") > 0, f"{name}: the time slider moves the mechanism")
    for canvas in canvases:
        checks.check(browser.run(PAINTED, canvas), f"{name}: {canvas} is drawn")
        checks.check(browser.run(IMAGE, canvas) != before[canvas], f"{name}: {canvas} moves")
    check_state(browser, name, checks)
    if browser.run("return gudgeon.scene.modes"):
        said = browser.run("return document.getElementById('state').textContent")
        checks.check("rod bent" in said and "drawn ×" in said, f"{name}: states the deflection of the rod: {said}")
        image = browser.run(IMAGE, "mechanism")
        browser.run("gudgeon.scene.modes = 0; gudgeon.seek(gudgeon.now)")
        checks.check(browser.run(IMAGE, "mechanism") != image, f"{name}: the rod is drawn bent")
        browser.run("gudgeon.scene.modes = 2; gudgeon.seek(gudgeon.now)")
    if clearance:
        image = browser.run(IMAGE, "joint")
        browser.run(MOVE, "magnification", 0.3)
        checks.check(browser.run(IMAGE, "joint") != image, f"{name}: the clearance is magnified")
        browser.run(MOVE, "magnification", 1)
    if browser.run("return gudgeon.scene.contacts.length"):
        browser.run("gudgeon.seek(0); document.getElementById('next').click()")
        inside = browser.run("return gudgeon.scene.contacts.some(c => gudgeon.now >= c.begin && gudgeon.now <= c.end)")
        checks.check(inside, f"{name}: the next contact is found")
        if pictures:
            browser.run("gudgeon.seek(0.3 * gudgeon.scene.contacts[0].begin + 0.7 * gudgeon.scene.contacts[0].end)")
            browser.screenshot(pictures / f"{name}_contact.png")

    browser.run("gudgeon.seek(0); document.getElementById('play').click()")
    checks.check(browser.wait("gudgeon.playing && gudgeon.now > 0", 60), f"{name}: plays")
    browser.run("document.getElementById('play').click()")
    stopped = browser.run("return gudgeon.now")
    time.sleep(0.3)
    checks.check(browser.run("return gudgeon.now") == stopped, f"{name}: pauses")

    cycle = browser.run("return gudgeon.scene.cycle")
    axis = browser.run("const l = gudgeon.charts.find(c => c.timed).div.layout; return [l.xaxis.title.text, ...l.xaxis.range, l.xaxis.dtick || 0]")
    if cycle:   # a dead centre in each half of a revolution, and one more where the first and the last are at the ends
        checks.check(axis == ["crank angle [deg]", cycle["from"], cycle["from"] + cycle["degrees"], 90] and cycle["from"] == (-360 if name == FIRES_AT_0 else 0),
                     f"{name}: opens on the last cycle, {axis}")
        peak = browser.run("const c = gudgeon.charts.find(c => c.curves[0].y === 'gas_force'); if (!c) return null; const d = c.div.data[0]; return d.x[d.y.indexOf(Math.max(...d.y))]")
        checks.check(peak is None or min(peak - axis[1], axis[2] - peak) > 90 or cycle["degrees"] < 720, f"{name}: the peak of the gas is not cut, {peak} in {axis}")
        lines = browser.wait("gudgeon.charts.find(c => c.timed).div.layout.shapes.filter(s => s.line && s.line.dash === 'dot').length >= "
                             f"{cycle['degrees'] / 180}", 10)
        checks.check(lines, f"{name}: dead centres are marked")
    width = "gudgeon.charts.find(c => c.timed).div.querySelector('svg').clientWidth"
    shown = browser.run(f"return {width}")
    browser.run("window.dispatchEvent(new Event('beforeprint'))")
    checks.check(browser.wait(f"{width} === 340", 10), f"{name}: charts are narrow on paper")
    browser.run("window.dispatchEvent(new Event('afterprint'))")
    checks.check(browser.wait(f"{width} === {shown}", 10), f"{name}: and wide again on the screen")
    browser.run(
        "const t = gudgeon.charts.filter(c => c.timed); Plotly.relayout(t[0].div,"
        "{'xaxis.range[0]': 1, 'xaxis.range[1]': 2})"
    )
    linked = browser.wait(
        "gudgeon.charts.filter(c => c.timed).every(c => Math.abs(c.div.layout.xaxis.range[1] - 2) < 1e-9)", 10
    )
    checks.check(linked, f"{name}: time axes zoom together")
    browser.run(CHOOSE, "angle", bool(cycle))
    titled = "gudgeon.charts.filter(c => c.timed).every(c => c.div.layout.xaxis.title.text === 'crank angle [deg]')"
    checks.check(browser.wait(titled, 30), f"{name}: plots over the crank angle")
    angles = browser.run("return gudgeon.charts.find(c => c.timed).div.data[0].x")
    if cycle:   # a gap is where the end of the run meets its beginning
        gaps = [a is not None and b is not None and not a - 1 < b < a + 20 for a, b in zip(angles, angles[1:])]
        angles = [angle for angle in angles if angle is not None]
        within = [angle - cycle["from"] for angle in (min(angles), max(angles))]
        checks.check(-1 < within[0] < 20 and 0.97 * cycle["degrees"] < within[1] < 1.002 * cycle["degrees"] and not any(gaps),
                     f"{name}: the last cycle alone, from {min(angles)} to {max(angles)} of {cycle}")
    browser.run(CHOOSE, "time", False)
    titled = titled.replace("crank angle [deg]", "time [ms]")
    checks.check(browser.wait(titled, 30), f"{name}: plots over time again")
    rows = browser.run("return gudgeon.charts.find(c => c.timed).div.data[0].x.length")
    checks.check(rows == browser.run("return gudgeon.scene.rows"), f"{name}: all rows again")
    answers = browser.run("return [...document.querySelectorAll('#answers tr')].map(r => r.textContent)")
    checks.check(len(answers) >= 1, f"{name}: answers: {answers}")
    checks.check(browser.run("return document.querySelector('section').id") == "answers", f"{name}: answers come first")
    messages = browser.messages()
    checks.check(not messages, f"{name}: console: {messages}")
    if pictures:
        browser.run(MOVE, "scrub", 0.62)
        time.sleep(1.0)
        browser.screenshot(pictures / f"{name}_top.png")
        browser.run("document.getElementById('plots').scrollIntoView()")
        browser.screenshot(pictures / f"{name}_plots.png")
        browser.run("document.querySelector('.tables').scrollIntoView()")
        browser.screenshot(pictures / f"{name}_tables.png")


#: Contrast (WCAG 2) of two colours of CSS.
CONTRAST = """const light = (c) => { const l = c.match(/[\\d.]+/g).slice(0, 3).map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  return 0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2]; };
const contrast = (a, b) => { const [x, y] = [light(a), light(b)].sort((p, q) => q - p); return (x + 0.05) / (y + 0.05); };
const style = (e, name) => getComputedStyle(e)[name], paper = style(document.body, 'backgroundColor');
const all = (q) => [...document.querySelectorAll(q)];
return {paper: light(paper), charts: all('#plots .main-svg:first-of-type, .planes .main-svg:first-of-type').map(s => light(style(s, 'backgroundColor'))),
  texts: Math.min(...all('h1, .hint, td, .warning').map(e => contrast(style(e, 'color'), style(e.closest('.warning') || document.body, 'backgroundColor'))),
    ...all('.gtitle, .xtick text').map(e => contrast(style(e, 'fill'), paper))),
  lines: Math.min(...all('.js-line').map(e => contrast(style(e, 'stroke'), paper)))};"""


#: Charts whose title is cut at their edge or covered by the legend or a tool bar, which is not there on paper.
CROWDED = """document.getElementById('more-plots').open = true; return gudgeon.charts.filter(c => { const box = s => c.div.querySelector(s)?.getBoundingClientRect(), title = box('.gtitle'), legend = box('.legend'),
  bar = box(arguments[0]); return title.right > box('.main-svg').right || (legend && legend.height && legend.top < title.bottom - 2) || (bar && bar.left < title.right); })
  .map(c => c.div.layout.title.text)"""

#: Widths of the views, of their first row and of its place; texts in tables that are cut; names that a line break parts from their colour.
FITS = """const all = (q) => [...document.querySelectorAll(q)];
const views = all('#views canvas').filter(c => c.clientWidth), first = views.filter(c => c.offsetTop === views[0].offsetTop);
return {page: document.body.clientWidth, width: document.getElementById('views').clientWidth, row: first.map(c => c.clientWidth).reduce((a, b) => a + b), views: all('#views canvas').map(c => c.clientWidth).filter(w => w), cut: all('#answers table, #losses table').filter(t => t.scrollWidth > t.clientWidth).map(t => t.textContent),
  parted: all('.key').filter(k => k.getClientRects().length > 1).map(k => k.textContent)};"""


#: Folded tables, opened: their height for each row [px], values that take several lines, and what is beyond the edge of the page.
UNFOLDED = """const folded = [...document.querySelectorAll('.tables details')];
const measure = (d) => { const rows = [...d.querySelectorAll('tr')], values = [...d.querySelectorAll('td:nth-child(2)')].filter(v => v.textContent.length <= 30);
  return {rows: rows.length, height: d.offsetHeight / rows.length, broken: values.filter(v => { const r = document.createRange(); r.selectNodeContents(v); return new Set([...r.getClientRects()].map(b => Math.round(b.top))).size > 1; }).map(v => v.textContent),
    outside: values.filter(v => v.getBoundingClientRect().right > document.documentElement.clientWidth).map(v => v.textContent)}; };
folded.forEach(d => { d.open = true; });
const found = folded.map(measure);
folded.forEach(d => { d.open = false; });
return found;"""


def check_screens(browser: Browser, page: Path, checks: Assertions, pictures: Path | None) -> None:
    """The page on screens of all sizes, in the dark and on paper. The least contrasts are those of WCAG 2: 4.5 of a text, 3 of a line."""
    for wanted in (1400, 1200, 800, 400):
        browser.width_at(wanted)
        browser.open(page)
        browser.wait("window.gudgeon && window.gudgeon.ready")
        checks.check((width := browser.width_at(wanted)) == wanted, f"{page.stem}: the page is {width} wide instead of {wanted}")
        fits = browser.run(FITS)
        checks.check(not fits["cut"] and not fits["parted"], f"{page.stem}: cut or parted texts", f"{wanted}: {fits}")
        checks.check(min(fits["views"]) >= 150 and fits["row"] > 0.75 * fits["width"], f"{page.stem}: views fill their rows", f"{wanted}: {fits}")
        checks.check(not (found := browser.run(CROWDED, '.modebar-group')), f"{page.stem}: crowded titles", f"{wanted}: {found}")
        wide = browser.run("const d = document.getElementById('cycles'); d.open = true; const a = [...d.querySelectorAll('.pictures img')].map(i => i.offsetWidth); d.open = false; return a")
        checks.check(not wide or sum(wide) > 0.85 * fits["page"], f"{page.stem}: pictures of settled cycles take {wide} of {fits['page']} at {wanted}")
        alone = browser.run("return document.body.matches('.unmagnified') && [...document.querySelectorAll('#mechanism, #engine, #timeline')].filter(c => c.clientWidth).map(c => c.clientWidth)")
        checks.check(not alone or wanted < 600 or alone[0] < 300, f"{page.stem}: a mechanism without other views has no empty panel: {alone} at {wanted}")
        for table in browser.run(UNFOLDED):
            checks.check((table["rows"] < 10 or table["height"] < 35) and not table["broken"] and not table["outside"], f"{page.stem}: values of folded tables stand on one line, within the page", f"{wanted}: {table}")
        if pictures:
            browser.screenshot(pictures / f"{page.stem}_{wanted}.png")
    browser.width_at(1200)   # a window that is made wider has the titles and legends of its width
    checks.check(browser.wait("gudgeon.charts.filter(c => c.main).every(c => c.div.layout.title.xref === 'paper' && c.div.layout.margin.l === 70)", 10), f"{page.stem}: titles follow the width of the window")
    checks.check(not (found := browser.run(CROWDED, ".none")), f"{page.stem}: crowded titles of a window that has been resized", str(found))
    browser.width_at(0)
    browser.open(page)
    browser.wait("window.gudgeon && window.gudgeon.ready")
    for scheme, is_dark in (("light", False), ("dark", True)):
        browser.cdp("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        browser.wait(f"(getComputedStyle(document.querySelector('.planes .js-line')).stroke === 'rgb(86, 180, 233)') === {str(is_dark).lower()}", 10)
        seen = browser.run(CONTRAST)
        checks.check((seen["paper"] < 0.05) == is_dark and all((one < 0.05) == is_dark for one in seen["charts"]) and seen["charts"], f"{scheme}: page and charts: {seen}")
        checks.check(seen["texts"] >= 4.5 and seen["lines"] >= 3, f"{scheme}: contrasts of texts and lines: {seen['texts']}, {seen['lines']}")
        if pictures:
            browser.screenshot(pictures / f"{scheme}.png")
    browser.run("window.dispatchEvent(new Event('beforeprint'))")
    checks.check(browser.run(CONTRAST)["paper"] > 0.9, "on paper a dark page is light")
    browser.cdp("Emulation.setEmulatedMedia", media="print")
    bars = browser.run("return [[...document.querySelectorAll('.bar i')], [...document.querySelectorAll('.key')]].map((all, i) => all.map(e => getComputedStyle(e, i ? '::before' : null).printColorAdjust)).flat()")
    checks.check(bars and set(bars) == {"exact"}, f"{page.stem}: bars and colours of legends are printed: {bars}")
    browser.wait("gudgeon.charts.find(c => c.timed).div.querySelector('svg').clientWidth === 340", 10)
    cut = browser.run("return gudgeon.charts.filter(({ div }) => div.clientHeight && div.querySelector('svg').clientHeight > div.clientHeight).map(c => c.div.layout.title.text)")
    checks.check(not cut, f"{page.stem}: charts on paper are cut, with the names of their axes", str(cut))
    browser.cdp("Emulation.setEmulatedMedia", media="")
    browser.wait("gudgeon.charts.find(c => c.timed).div.querySelector('svg').clientWidth === 340", 10)
    checks.check(not (found := browser.run(CROWDED, '.none')), f"{page.stem}: crowded titles on paper", str(found))
    browser.run("window.dispatchEvent(new Event('afterprint'))")
    checks.check(not (said := browser.messages()), f"console: {said}")


def summarised(summary: dict[str, tuple[str, str]], case: dict | None = None) -> SimpleNamespace:
    """A run of which there is a summary."""
    return SimpleNamespace(summary=summary, case=case or {})


def check_shaft(checks: Assertions) -> None:
    """Six cylinders on a shaft that twists: what the shaft does, and where it does so."""
    rows = {"cycle_start": ("0", "s"), "cycle_mean_crank_speed": ("209.4395102", "rad/s"), "cycle_speed_fluctuation": ("0.27425", "1"), "front_irregularity": ("0.28758", "1"),
            "cyclic_irregularity": ("0", "1"), "cycle_max_station_1_twist": ("1.19e-3", "rad"), "cycle_max_station_9_twist": ("3.269695e-2", "rad"), "max_station_1_twist": ("0.5", "rad"),
            "cycle_front_twist_order_0.5": ("1.15e-3", "rad"), "cycle_front_twist_order_6": ("1.754763e-2", "rad"), "cycle_segment_1_torque_order_6": ("9e5", "N.m"),
            "cycle_max_segment_7_torque": ("8954.85", "N.m"), "cycle_max_segment_8_torque": ("8940.5", "N.m"), "max_segment_1_torque": ("9e9", "N.m")}
    engine = summarised(rows, {"cylinder_1": {"full": False}, "cylinder_2": {"full": True}, "cylinder_10": {"full": False}})
    found = dict(lines(engine)[2])
    wanted = {"Forces and plots": "cylinder 2 of 3", "Largest twist of the shaft": "32.7 mrad, station 9 against the crank of cylinder 2",
              "Crank speed": "2000 rpm, fluctuates by 27.4 % at the crank of cylinder 2, 28.8 % at the front end, 0 % at the driven end",
              "Strongest order of the twist": "order 6, 17.55 mrad of the front end against the driven end", "Largest torque in the shaft": "8.955 kN m, segment 7"}
    checks.check(found == wanted, f"answers of a shaft: {found}")
    portuguese = Language("pt")
    said = [portuguese.say(text) for line in wanted.items() for text in line]
    checks.check(not portuguese.unknown and "32,7 mrad, estação 9 em relação à manivela do cilindro 2" in said, f"a shaft in Portuguese: {portuguese.unknown}, {said}")
    of_run = {name: value for name, value in rows.items() if not name.startswith("cycle_")}
    found = dict(lines(summarised(of_run))[2])
    checks.check(found.get("Largest twist of the shaft", "").startswith("500 mrad, station 1") and "Strongest order of the twist" not in found, f"a run without a cycle: {found}")
    found = dict(lines(summarised({"cycle_start": ("0", "s"), "cycle_max_crankshaft_twist": ("3.6375e-3", "rad")}))[2])
    checks.check(found == {"Largest twist of the shaft": "3.638 mrad"}, f"a shaft of one crank and a flywheel: {found}")


def check_answers(checks: Assertions) -> None:
    """The answers are the values of the summary, in the units of an engineer."""
    rows = {"min_film_thickness": ("1e-6", "m"), "cycle_start": ("0", "s"), "cycle_revolutions": ("2", "1"),
            "cycle_min_film_thickness": ("2.5e-6", "m"), "cycle_min_film_thickness_angle": ("643.25", "deg"),
            "cycle_mean_film_power": ("100", "W"), "cycle_mean_friction_power": ("20", "W"), "cycle_max_force": ("1234.5", "N"),
            "crank_pin_min_film_thickness": ("3e-6", "m"), "crank_pin_cycle_min_film_thickness": ("-56.2e-6", "m"),
            "crank_pin_max_penetration": ("78e-6", "m"), "crank_pin_contacts": ("51", "1"), "crank_pin_impacts_beyond_validity": ("50", "1"),
            "crank_pin_cycle_contact_share": ("0.75", "1"), "crank_pin_contact_time_fraction": ("0.5", "1"),
            "crank_pin_max_pin_force": ("9e3", "N"), "crank_pin_film_temperature": ("400.15", "K"), "crank_pin_cycle_mean_film_temperature": ("373.15", "K"),
            "crank_pin_cycle_mean_film_side_flow": ("1e-6", "m3/s"), "cycle_imep": ("9.8e5", "Pa"), "cycle_bmep": ("9.7e5", "Pa"),
            "cycle_reversed_load": ("302.4", "N"), "cycle_degrees_under_reversed_load": ("52.6", "deg"), "cycle_max_force_angle": ("12", "deg"),
            "cycle_slap_speed": ("0.4894", "m/s"), "cycle_slap_angle": ("373.4", "deg"), "cycle_slap_corner": ("guide_3", ""),
            "cycle_slap_energy": ("0.0286", "J"), "cycle_slap_impacts": ("73", "1"), "crank_pin_cycle_impacts": ("20", "1"),
            "crank_pin_cycle_max_impact_speed": ("1.386", "m/s"), "crank_pin_cycle_wear_depth_100h_bore": ("2.5e-6", "m"),
            "cycle_fmep": ("1e4", "Pa"), "cycle_one_way_fmep": ("4e3", "Pa"), "cycle_mean_crank_speed": ("314.159265358979", "rad/s"), "cycle_is_settled": ("no", ""),
            "film_thickness_change": ("0.65", "1"), "cycle_max_drive_torque": ("14.77", "N.m"), "cycle_min_drive_torque": ("-390", "N.m"), "pin_swing": ("0.1", "rad"),
            "cycle_work_drive": ("-842.7", "J")}
    places, ours, others = lines(summarised(rows))
    said = {name: texts for name, texts in ours} | {name: [text] for name, text in others}
    wanted = {"Thinnest film": ["2.5 µm at 643.2°", ""], "Deepest penetration": ["", "56.2 µm"], "Largest force": ["1.234 kN at 12.0°; reversed 302.4 N over 53°", ""],
              "Mean loss": ["120 W", ""], "In contact": ["", "75 %, 20 impacts at up to 1.386 m/s"], "Wear of the bore in 100 h": ["", "2.5 µm"],   # of the cycle, not the 78 µm, 50 % and 9 kN of the whole run
              "Film temperature": ["", "100 °C"], "Oil flow": ["", "60 cm³/min"],
              "Hardest slap": ["0.4894 m/s at 373.4°, corner 3, 28.6 mJ; 73 impacts"],
              "Mean effective pressures": ["IMEP 9.8 bar, BMEP 9.7 bar, FMEP 0.1 bar (bearings 4 kPa, not fed back)"],
              "Crank speed": ["3000 rpm"], "Drive torque": ["−390 N m to 14.77 N m, mean −67.06 N m"], "Piston pin": ["swings by 5.73°"]}   # none is left out, however many there are
    checks.check(places == ["piston pin", "crank pin"], f"bearings with answers: {places}")
    checks.check(said == wanted, f"answers: {said}")
    gases = ({"cycle_max_gas_temperature": ("1235.43", "K"), "cycle_heat_to_walls": ("33.48", "J"), "cycle_leak_share": ("0.01007", "1"), "cycle_indicated_efficiency": ("0.4666", "1")},
             {"cycle_max_gas_temperature": ("491.4", "K"), "cycle_wall_heat_flow": ("21.5", "W"), "cycle_leak_flow": ("2.47e-5", "kg/s"), "cycle_mass_flow": ("7.544e-3", "kg/s"),
              "cycle_volumetric_efficiency": ("0.8439", "1"), "cycle_isentropic_efficiency": ("0.9247", "1"), "cycle_discharge_temperature": ("488.4", "K"),
              "cycle_suction_loss": ("51.1", "W"), "cycle_discharge_loss": ("31.8", "W"), "cycle_max_suction_valve_speed": ("2.35", "m/s"),
              "cycle_max_discharge_valve_speed": ("4.1", "m/s")}, {"cycle_volumetric_efficiency": ("0.8922", "1")})
    texts = ("up to 962.3 °C, to the walls 33.48 J, leak 1.007 %, efficiency 46.66 %",
             "up to 218.2 °C, to the walls 21.5 W, leak 0.0247 g/s, delivers 7.544 g/s, volumetric efficiency 84.39 %, isentropic efficiency 92.47 %, delivery temperature 215.2 °C, "
             "lost in the suction valve 51.1 W, in the discharge valve 31.8 W, suction valve hits with 2.35 m/s, discharge valve hits with 4.1 m/s", "volumetric efficiency 89.22 %")
    portuguese = Language("pt")
    for summary, text in zip(gases, texts):
        found = dict(lines(summarised({"cycle_start": ("0", "s")} | summary))[2])["Gas"]
        checks.check(found == text, f"answers of the gas: {found}")
        checks.check(len(portuguese.say(found)) > 10 and not portuguese.unknown, f"answers of the gas in Portuguese: {portuguese.unknown}")
    flutter = {"cycle_start": ("0", "s"), "cycle_max_gas_temperature": ("400", "K"), "cycle_mass_flow": ("2.67e-4", "kg/s"), "recent_mass_flow": ("2.43e-4", "kg/s")}
    for scatter, text in (("0.44", "up to 126.9 °C, delivers 0.267 g/s, in the mean of the last revolutions 0.243 g/s"), ("1e-4", "up to 126.9 °C, delivers 0.267 g/s")):
        found = dict(lines(summarised(flutter | {"recent_mass_flow_scatter": (scatter, "1")}))[2])["Gas"]
        checks.check(found == text and len(portuguese.say(found)) > 10 and not portuguese.unknown, f"the flow of valves that flutter: {found}, {portuguese.unknown}")
    of_losses = {"cycle_work_gas": ("200", "J"), "cycle_imep": ("8e5", "Pa"), "cycle_fmep": ("2.5e4", "Pa"), "cycle_indicated_power": ("8e3", "W"), "cycle_work_guide": ("-4", "J"),
                 "cycle_ring_fmep": ("1e4", "Pa"), "cycle_ring_1_fmep": ("7e3", "Pa"), "cycle_ring_2_fmep": ("3e3", "Pa"), "crank_pin_cycle_joint_fmep": ("6e3", "Pa"),
                 "cycle_joint_fmep": ("2e3", "Pa"), "cycle_work_contact": ("-0.25", "J")}
    parts = losses_of(Answers(summarised(of_losses)))
    wanted = [("Ring 1", 7e3), ("Ring 2", 3e3), ("Piston pin", 3e3), ("Crank pin", 6e3), ("Piston in its bore", 6e3)]
    checks.check([name for name, *_ in parts] == [name for name, _ in wanted] and all(abs(a - b) < 1e-6 for (_, a, _), (_, b) in zip(parts, wanted)), f"parts of FMEP: {parts}")
    checks.check(abs(sum(value for _, value, _ in parts) - 2.5e4) < 1e-6, "they are all of it")
    film = {"cycle_skirt_fmep": ("4e3", "Pa"), "cycle_max_slap_speed": ("0.0464", "m/s"), "cycle_max_slap_speed_angle": ("378.3", "deg"),
            "cycle_min_skirt_film_thickness": ("1.145e-5", "m"), "cycle_min_skirt_film_thickness_angle": ("529.8", "deg")}
    parts = losses_of(Answers(summarised(of_losses | film)))
    checks.check(parts[-2] == ("Skirt", 4e3, 0.0) and abs(parts[-1][1] - 2e3) < 1e-6, f"the film of the skirt has its own part: {parts}")
    checks.check(("Hardest slap", "46.4 mm/s at 378.3°, film from 11.45 µm at 529.8°") in lines(summarised(rows | film))[2], "slap of a skirt on its film")
    for value, unit, text in ((-600.7, "W", "−600.7 W"), (130.6, "N", "130.6 N"), (3.934, "N", "3.934 N"), (5.966e-9, "m", "5.966 nm"), (6.322e-7, "m", "0.6322 µm"), (1.13, "s", "1.13 s"),
                              (8.8858e5, "bar", "8.886 bar"), (71.85, "bar", "71.85 Pa"), (5522, "N m", "5.522 kN m"), (4.825e-6, "m", "4.825 µm"), (-1.033e-8, "J", "−10.33 nJ"), (0.4894, "m/s", "0.4894 m/s"),
                              (0.0464, "m/s", "46.4 mm/s"), (0.0, "W", "0 W"), (1e-13, "J", "1e−13 J"), (314.2, "cm³/min", "314.2 cm³/min"), (20000.0, "rpm", "20000 rpm"), (-11504.0, "rpm", "−11500 rpm"),
                              (2.5e7, "cm³/min", "2.5e+07 cm³/min")):
        checks.check(amount(value, unit) == text, f"units as engineers write them: {amount(value, unit)}, wanted {text}")
    said = {text for _, texts in ours for text in texts} | {text for _, text in others}
    portuguese.unknown.clear()
    spoken = {text: portuguese.say(text) for text in said}
    checks.check(not portuguese.unknown, f"answers in Portuguese: {portuguese.unknown}")
    checks.check(spoken["1.234 kN at 12.0°; reversed 302.4 N over 53°"] == "1,234 kN a 12,0°; invertida 302,4 N durante 53°", f"a duration: {spoken}")
    bearings = {f"{name}_{row}": value for name, film in (("main_bearing_10", "4e-6"), ("main_bearing_2", "3e-6"), ("crank_pin_1", "2e-6")) for row, value in (
        ("min_film_thickness", ("1e-6", "m")), ("cycle_min_film_thickness", (film, "m")), ("cycle_min_film_thickness_angle", ("12", "deg")),
        ("cycle_max_film_pressure", ("4.5e7", "Pa")), ("cycle_mean_film_power", ("0.25", "W")), ("cycle_max_force", ("1234.5", "N")),
        ("cycle_reversed_load", ("30", "N")), ("cycle_mean_film_side_flow", ("1e-6", "m3/s")), ("cycle_degrees_under_reversed_load", ("40", "deg")), ("cycle_joint_fmep", ("2e3", "Pa")))}
    engine = summarised(of_losses | bearings | {"cycle_start": ("0", "s"), "cycle_thinnest_bearing": ("crank_pin_1", ""), "cycle_bearings_power": ("1234", "W"), "cycle_bmep": ("7.75e5", "Pa"),
                                                               "cycle_brake_power": ("7.75e3", "W")})
    heads, table = of_numbered(engine)
    checks.check(heads == ["Thinnest film", "Largest film pressure", "Largest force", "Mean loss"], f"what is said of numbered bearings: {heads}")
    checks.check(table == [("main bearing 2", ["3 µm at 12.0°", "45 MPa", "1.234 kN", "250 mW"]), ("main bearing 10", ["4 µm at 12.0°", "45 MPa", "1.234 kN", "250 mW"]),
                           ("crank pin 1", ["2 µm at 12.0°", "45 MPa", "1.234 kN", "250 mW"])], f"numbered bearings in their order: {table}")
    checks.check(lines(engine)[2][:3] == [("Thinnest film", "2 µm at 12.0°, crank pin 1"), ("Loss of all bearings", "1.234 kW"), ("Oil flow of all bearings", "180 cm³/min")], f"of all bearings: {lines(engine)[2]}")
    listed = answers_of(summarised({name: (value, "") for name, value in {"min_film_thickness": "1e-6", "cycle_min_film_thickness": "8e-6"}.items()} | bearings | {
        "cycle_start": ("0", "s"), "cycle_thinnest_bearing": ("crank_pin_1", "")}), Language().say)
    checks.check([pair for pair in listed if "film" in pair[0] or "2" in pair[0]] == [("Thinnest film, piston pin", "8 µm"), ("Thinnest film", "2 µm at 12.0°, crank pin 1"),
                 ("main bearing 2", "3 µm at 12.0°, 45 MPa, 1.234 kN, 250 mW")] and len(dict(listed)) == len(listed), f"the explorer's answers of numbered bearings: {listed}")
    for key, value, text in (("kg", 0.00015, "0.15 g"), ("kg", 0.38, "0.38 kg"), ("kg", 9e3, "9000 kg"), ("kg m^2", 2e-9, "2 g mm²"), ("kg m^2", 4e-5, "40 kg mm²"), ("kg m^2", 0.0045, "0.0045 kg m²"),
                             ("m^2", 2.5e-5, "0.25 cm²"), ("m^2", 2e-8, "0.02 mm²"), ("J", 2.9e6, "2900 kJ"), ("J", 190.0, "190 J"), ("N", 0.05, "0.05 N"), ("rad/s", math.pi, "30 rpm")):
        unit, factor, offset = shown_unit(key, value)
        checks.check(f"{value * factor + offset:.4g} {unit}" == text, f"a slider of {value} {key}: {value * factor + offset:.4g} {unit}, wanted {text}")
    parts = {name: value for name, value, _ in losses_of(Answers(engine))}
    checks.check([parts.get(name) for name in ("Main bearing 2", "Main bearing 10", "Crank pin 1")] == [2e3] * 3, f"their parts in the losses: {parts}")
    portuguese.unknown.clear()
    text = section(engine, portuguese)
    checks.check("<td>mancal principal 10</td><td>4 µm a 12,0°</td>" in text and "<td>Pino da manivela 1</td>" in text and not portuguese.unknown, f"in Portuguese: {portuguese.unknown}, {text}")
    text = section(summarised(of_losses))
    checks.check("<td>Crank pin</td><td>6 kPa</td><td>60 W</td><td>24 %</td>" in text and "<td>All losses (FMEP)</td><td>25 kPa</td><td>250 W</td>" in text, f"table of losses: {text}")
    for value, difference, text in ((123.456, 0.02, "123.5"), (123.456, 0.3, "123.<i>5</i>"), (123.456, 0.6, "12<i>3.5</i>"), (123.456, 30, "1<i>23.5</i>"), (-0.005966, 2e-5, "−0.0059<i>66</i>"),
                                    (1.234e-9, 1e-12, "1.23<i>4</i>e−09"), (1.234, math.inf, "<i>1.234</i>"), (1.234, math.nan, "<i>1.234</i>"), (0.0, 0.0, "0")):
        found = html_of(number(value, difference))
        checks.check(found == text.replace("<i>", '<span class="loose">').replace("</i>", "</span>"), f"certified digits: {found}")
    certified = summarised(rows | {"certified_until": ("1", "s"), "cycle_max_force_difference": ("-0.3", "N")})
    found = dict(lines(certified)[1])
    checks.check(html_of(found["Largest force"][0]).startswith('1.234 kN at <span class="loose">12.0</span>°; reversed <span class="loose">302.4</span> N'), f"certified answers: {found}")
    checks.check(html_of(Language("pt").say(found["Largest force"][0])).startswith('1,234 kN a <span class="loose">12,0</span>°'), f"in Portuguese: {Language('pt').say(found['Largest force'][0])}")
    # 6123 Pa of the crank pin, known to 4 Pa; as much of the piston in its bore, the difference of 16 kPa (4 J, known to 0.001 J) and 10 kPa (known to 12 Pa)
    known = {f"{name}_difference": (size, "") for name, size in (("cycle_fmep", "20"), ("crank_pin_cycle_joint_fmep", "-4"), ("cycle_work_guide", "0.001"), ("cycle_ring_fmep", "12"))}
    known |= {"certified_until": ("1", "s"), "crank_pin_cycle_joint_fmep": ("6123.4", "Pa"), "cycle_fmep": ("25123.4", "Pa"), "cycle_work_guide": ("-4.03085", "J")}
    text = section(summarised(of_losses | known))
    for name, wanted in (("Crank pin", ("6.12<i>3</i> kPa", "61.2<i>3</i> W", "24.4 %")), ("Piston in its bore", ("6.1<i>23</i> kPa", "61.<i>23</i> W", "24.<i>4</i> %")),
                         ("Ring 1", ("<i>7</i> kPa", "<i>70</i> W", "<i>27.9</i> %")), ("All losses (FMEP)", ("25.1<i>2</i> kPa", "251.<i>2</i> W", ""))):
        cells = "".join(f"<td>{cell}</td>" for cell in (name, *wanted)).replace("<i>", '<span class="loose">').replace("</i>", "</span>")
        checks.check(cells in text, f"certified losses: {name}: {text}")
    said = warnings(summarised(rows))
    checks.check(len(said) == 2 and "piston pin changes by 65 %" in said[0] and "run.until=periodic" in said[0], f"a motion that has not settled: {said}")
    checks.check(said[1].startswith("50 of 51 contacts at the crank pin are faster"), f"contacts beyond the theory: {said}")
    said = warnings(summarised(rows | {"motion": ("not_periodic", ""), "crank_revolutions": ("1000", "1")}))[0]   # the case asked for it already
    checks.check("did not repeat within 1000 revolutions: the film thickness at the piston pin changes by 65 %" in said and "run.until" not in said, f"a motion that does not repeat: {said}")
    portuguese.unknown.clear()
    checks.check("1000 rotações" in portuguese.say(said) and not portuguese.unknown, f"the same in Portuguese: {portuguese.unknown}")
    for name in [name for name in rows if "cycle_" in name]:
        del rows[name]
    _, ours, others = lines(summarised(rows))
    of_run = dict(ours)
    checks.check(of_run["Thinnest film"] == ["1 µm", "3 µm"] and of_run["In contact"] == ["", "50 %"] and of_run["Film temperature"] == ["", "127 °C at the end"],
                 f"answers of a run without a cycle: {ours}")


def fires_at_0(folder: Path) -> Path:
    """The case."""
    rows = [row.split(",") for row in (TOP / "cases/gas/indicator.csv").read_text().splitlines()[2:]]
    (folder / "rig.csv").write_text("crank_angle[deg],pressure[bar]\n" + "".join(f"{float(angle) - 360:g},{pressure}\n" for angle, pressure in rows))
    case = folder / f"{FIRES_AT_0}.nml"
    case.write_text((TOP / "cases/gas/measured.nml").read_text().replace("'indicator.csv'", "'rig.csv'").replace("crank_angle_deg = 0.0", "crank_angle_deg = 100.0"))
    return case


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", nargs="*", type=Path)
    parser.add_argument("--screenshots", type=Path, metavar="DIR")
    options = parser.parse_args()
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    driver = shutil.which("chromedriver")
    if not chromium or not driver:
        print("Chromium is not installed: scripts/setup.sh --browser (or apt-get install chromium chromium-driver)\n0 passed, 1 failed")
        return 1
    if options.screenshots:
        options.screenshots.mkdir(parents=True, exist_ok=True)
    checks = Assertions()
    check_answers(checks)
    check_shaft(checks)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as work:   # Chromium may still be writing
        pages = options.page
        for case in (*CASES, FIRES_AT_0) if not pages else ():
            page = Path(work) / f"{case}.html"
            source = fires_at_0(Path(work)) if case == FIRES_AT_0 else next((TOP / "cases").rglob(f"{case}.nml"))
            if case == FAR_AWAY:   # a page shows the paths of tables and the name of the case
                folder = Path(shutil.copytree(source.parent, Path(work, "folders-of-a-server", *["0123456789abcdef" * 3] * 3)))
                source = (folder / source.name).rename(folder / f"{'torsional_vibration_' * 5}{source.name}")
            made = subprocess.run(
                [TOP / ".venv" / "bin" / "gudgeon-plot", "report", source, "--results", work, "-o", str(page)],
                check=False,
                env=os.environ | {"GUDGEON_LIBRARY": f"{work}/none.so"},   # whether another test has built it or not
            )
            checks.check(made.returncode == 0, f"{case}: the page is made")
            if made.returncode == 0:
                pages = [*pages, page]
        browser = Browser(chromium, driver, str(Path(work) / "profile"))
        try:
            for page in pages:
                check_page(browser, page, checks, options.screenshots)
            for page in [page for page in pages if options.page or page.stem in ("ideal", "piston", "car_diesel", "six_mwm", "inline_four_bearings")]:
                check_screens(browser, page, checks, options.screenshots)
        finally:
            browser.close()
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
