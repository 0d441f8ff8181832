#!/usr/bin/env python3
"""Opens pages of gudgeon-plot explore in headless Chromium: sliders run the case, what is drawn is what the library computes, wrong and slow
cases are told, kept runs stay, values leave.

    tests/test_explore.py [--screenshots DIR] [--program GUDGEON]
    tests/test_explore.py --changes 500       memory and waiting times of so many changes alone (default: 60 among the others)

Needs the library (scripts/python/build_library.py), the program, and chromium and chromium-driver, without which the test fails.
Ends with the line "N passed, N failed".
"""

import argparse
import http.server
import json
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import gudgeon
import numpy as np
from assertions import Assertions
from gudgeon.language import Language
from gudgeon.plots.style import fewer_colours
from gudgeon.program import release_program
from gudgeon.report.explorer import Explorer, slider_range
from test_explore_server import served
from test_report import IMAGE, PAINTED, Browser  # restarts in .venv

TOP = Path(__file__).resolve().parents[1]
TEMPLATES = ("dry", "film", "engine", "compressor", "slap", "elastic", "wear")
READY = "window.explorer && explorer.shown && !explorer.busy"

#: A slider at a part of its range, as a hand moves it.
SLIDE = """const e = document.querySelector(`[data-key="${arguments[0]}"] [type=range]`); e.value = 200 * arguments[1];
e.dispatchEvent(new Event('input', {bubbles: true}));"""
#: What is typed into the box of a key.
TYPE = """const e = document.querySelector(`[data-key="${arguments[0]}"] [type=text], [data-key="${arguments[0]}"] select`);
e.value = arguments[1]; e.dispatchEvent(new Event('change', {bubbles: true}));"""
BOX = """return document.querySelector(`[data-key="${arguments[0]}"] [type=text]`).value"""
ANSWERS = "return Object.fromEntries([...document.querySelectorAll('#answers tr')].slice(1).map(r => [...r.children].map(c => c.textContent)).map(c => [c[0], c[1]]))"
COLUMN = "return Array.from(explorer.shown.column[arguments[0]])"
FAILURE = "return document.getElementById('failure').hidden ? '' : document.getElementById('failure').textContent"
CHART = "return document.querySelector('#charts canvas').toDataURL()"
#: The crank angle of the animation within the cycle [degrees].
ANGLE = "return angleInCycle(explorer.shown.scene.cycle, explorer.drawing.at('crank_angle'))"
#: Bytes that were sent for the page, and what it has asked for since.
SENT = "return [performance.getEntriesByType('navigation')[0].encodedBodySize, performance.getEntriesByType('resource').map(r => r.name)]"
#: The saved picture: its size, the colours in it, and whether it has the blue of the shown curves.
PICTURE = """const done = arguments[0];
createImageBitmap(window.blob).then(image => { const c = document.createElement('canvas'); c.width = image.width; c.height = image.height;
  const g = c.getContext('2d'); g.drawImage(image, 0, 0); const data = new Uint32Array(g.getImageData(0, 0, c.width, c.height).data.buffer);
  done([c.width, c.height, new Set(data).size, data.includes(0xffb27200)]); }).catch(error => done(String(error)));"""


def case_of_readme() -> gudgeon.Case:
    """The first case of the README."""
    text = (TOP / "README.md").read_text(encoding="utf-8")
    block = text[text.index("    &mechanism") :].partition("\n\n")[0]
    return gudgeon.Case.from_text("\n".join(line.strip() for line in block.splitlines()), "pin")


class Page:
    """A page of an explorer in the browser."""

    def __init__(self, browser: Browser, address: str) -> None:
        self.browser = browser
        browser.call("POST", "/url", {"url": address})

    def settled(self, seconds: float = 120) -> bool:
        """Wait for the run in full."""
        return self.browser.wait(f"{READY} && (!explorer.shown.head.draft || explorer.shown.head.failed)", seconds)

    def moved(self, script: str, *values: object) -> bool:
        """Do something that asks for a run, and wait for the one in full."""
        count = self.browser.run("return explorer.runs.length")
        self.browser.run(script, *values)
        return self.browser.wait(f"explorer.runs.length > {count}") and self.settled()

    def failure(self) -> str:
        return str(self.browser.run(FAILURE))


def same_rows(page: Page, run: gudgeon.Run, name: str) -> bool:
    """Whether a column of the page has the values of the last cycle of a run, bit for bit."""
    shown = np.array(page.browser.run(COLUMN, name), dtype="f4")
    begin = run.summary["cycle_start"]
    rows = run[name][run["time"] >= begin - 1e-4 * run.summary["cycle_duration"]].astype("f4")
    return len(shown) > 100 and (np.array_equal(shown, rows) or set(shown) <= set(rows))


def check_notes(browser: Browser, checks: Assertions) -> None:
    """Notes are seen without a turn of the wheel, those on results before those on keys, however many answers and kept runs there are."""
    with served(Explorer(gudgeon.template("compressor").set({"mechanism.piston_mass": 30.0}))) as server:
        page = Page(browser, server.address)
        checks.check(page.settled(60), "a run with notes is shown", page.failure())
        browser.run("document.getElementById('keep').click()")
        said = browser.run("const top = document.getElementById('top').getBoundingClientRect(); return [...document.querySelectorAll('#notes p')].map(p => [p.textContent, p.getBoundingClientRect().bottom <= top.bottom])")
        checks.check(len(said) > 1 and said[0][0].startswith("piston pin: a film of") and said[0][1], "its first note is on its results, and in sight", str(said))


def check_pages(browser: Browser, checks: Assertions) -> None:
    """Each template and the README's case are drawn, and the console says nothing."""
    for case in [*(gudgeon.template(kind) for kind in TEMPLATES), case_of_readme()]:
        with served(Explorer(case)) as server:
            page = Page(browser, server.address)
            checks.check(page.settled(60), f"{case.name}: a run is shown", page.failure())
            canvases = ["mechanism", "timeline"] + (["orbit", "joint"] if browser.run("return explorer.shown.scene.clearance > 0") else [])
            for canvas in canvases:
                checks.check(browser.run(PAINTED, canvas), f"{case.name}: {canvas} is drawn")
            checks.check(browser.run("return document.querySelectorAll('#charts canvas').length") >= 2, f"{case.name}: curves")
            checks.check(len(browser.run(ANSWERS)) >= 2, f"{case.name}: answers")
            checks.check(browser.run("return document.querySelectorAll('.slider').length") >= 4, f"{case.name}: sliders")
            checks.check(not (said := browser.messages()), f"{case.name}: console", str(said))
            size, others = browser.run(SENT)
            checks.check(0 < size < 40_000, f"{case.name}: {size} bytes are sent for the page")
            checks.check(others and all(name.startswith((f"http://127.0.0.1:{server.server_port}/", "data:")) for name in others), f"{case.name}: asks no other machine", str(others))
            head, data = server.explorer.scene(case.run())
            size = len(json.dumps(head)) + sum(map(len, data.values()))
            checks.check(size < 300_000, f"{case.name}: a run has {size} bytes")


def check_sliders(browser: Browser, checks: Assertions, program: Path) -> None:
    """What the hand does to a case of dry contact, and what leaves the page."""
    case = gudgeon.template("dry")
    with served(Explorer(case, "gudgeon.template('dry')")) as server:
        page = Page(browser, server.address)
        checks.check(page.settled(), "the page opens with the case as given")
        checks.check(same_rows(page, case.run(), "piston_acceleration"), "its curve is that of case.run()")
        key = "joint.clearance"
        before = [browser.run(CHART), browser.run(ANSWERS), browser.run(BOX, key), browser.run(IMAGE, "orbit")]
        checks.check(page.moved(SLIDE, key, 0.9), "a slider runs the case")
        after = [browser.run(CHART), browser.run(ANSWERS), browser.run(BOX, key), browser.run(IMAGE, "orbit")]
        checks.check(all(a != b for a, b in zip(before, after)), "curve, answers, box and orbit follow")
        value = browser.run(f"return explorer.values['{key}']")
        run = case.set({key: value}).run()
        for name in ("pin_force", "piston_acceleration", "eccentricity_x"):
            column = np.hypot(run["pin_force_x"], run["pin_force_y"]) if name == "pin_force" else None
            if column is None:
                checks.check(same_rows(page, run, name), f"{name} is that of the library, bit for bit")
        low, high = slider_range(gudgeon.keys[key], case[key])
        checks.check(low <= value <= high, "the value is on the slider")

        # a slider by the keyboard
        element = browser.call("POST", "/element", {"using": "css selector", "value": f'[data-key="{key}"] [type=range]'})
        count = browser.run("return explorer.runs.length")
        browser.call("POST", f"/element/{next(iter(element.values()))}/value", {"text": "\ue012"})   # arrow to the left
        browser.wait(f"explorer.runs.length > {count}")
        checks.check(browser.run(f"return explorer.values['{key}']") < value, "an arrow key moves the slider")

        # values as the case file takes them
        checks.check(page.moved(TYPE, key, "0.02 mm"), "a unit of another size")
        checks.check(browser.run(f"return explorer.values['{key}']") == 2e-5 and browser.run(BOX, key) == "20 µm", "is read by the program")
        checks.check(page.moved(TYPE, key, "30,5"), "a number in the unit that is shown")
        checks.check(browser.run(f"return explorer.values['{key}']") == 30.5 / 1e6, "with a decimal comma")

        # kept runs
        browser.run("document.getElementById('keep').click()")
        image = browser.run(CHART)
        checks.check(page.moved(SLIDE, "contact.dissipation", 0.1) and browser.run(CHART) != image, "a kept run stays behind the next one")
        rows = browser.run("return [...document.querySelectorAll('#answers .key-row')].map(r => [...r.children].map(c => c.textContent))")
        checks.check(rows == [["contact.dissipation", browser.run(BOX, "contact.dissipation"), f"{case['contact.dissipation']:g} s/m"]], "the table has the values in which they differ", str(rows))
        for _ in range(5):
            browser.run("document.getElementById('keep').click()")
        checks.check(browser.run("return explorer.kept.length") == 4, "four at most")
        checks.check(page.moved("document.querySelector('#answers tr').lastChild.querySelector('button').click()"), "back to a kept run")
        checks.check("contact.dissipation" in browser.run("return explorer.values"), "with its values")
        browser.run("[...document.querySelectorAll('#answers tr th button')].filter(b => b.textContent === '×').forEach(b => b.click())")
        checks.check(browser.run("return explorer.kept.length") == 0, "kept runs are removed")

        # what leaves
        browser.run("document.getElementById('copy-set').click()")
        words = browser.run("return document.getElementById('copied').textContent")
        with tempfile.TemporaryDirectory() as folder:
            work = Path(folder)
            case.to_nml(work / "CASE.nml")
            done = subprocess.run(words.replace("gudgeon", shlex.join([str(program), "-q", "-o", str(work)]), 1), shell=True, cwd=work, capture_output=True, text=True, check=False)
            here = server.explorer.changed(browser.run("return explorer.values")).run()
            rows = dict(line.split(",")[:2] for line in (work / "CASE.summary.csv").read_text().splitlines()) if done.returncode == 0 else {}
            kept = [name for name in rows if name.startswith(("min_", "max_", "cycle_m"))]
            checks.check(len(kept) > 5 and all(str(here.summary._texts[name]) == rows[name] for name in kept), "the copied command line makes the same run", done.stderr)
        browser.run("document.getElementById('copy-python').click()")
        code = browser.run("return document.getElementById('copied').textContent")
        again = eval(code, {"gudgeon": gudgeon})
        checks.check(np.array_equal(again["pin_force_x"], here["pin_force_x"]), "and so does Python")
        text = server.explorer.case_text(browser.run("return explorer.values")).decode()
        checks.check(text.startswith("! gudgeon ") and np.array_equal(gudgeon.Case.from_text(text).run()["pin_force_x"], here["pin_force_x"]), "and the case file")
        browser.run("window.saved = []; URL.createObjectURL = (blob) => { blob.text().then((text) => window.saved.push(text)); return 'data:,'; }")
        for button, begin in (("save-case", "! gudgeon "), ("save-csv", "time[s]"), ("save-page", "<!DOCTYPE html>")):
            count = browser.run("return window.saved.length")
            browser.run("document.getElementById(arguments[0]).click()", button)
            checks.check(browser.wait(f"window.saved.length > {count} && window.saved[{count}].startsWith('{begin}')"), f"{button} saves")
        again = gudgeon.Case.from_text(browser.run("return window.saved[0]"))
        checks.check(np.array_equal(again.run()["pin_force_x"], here["pin_force_x"]), "the saved case read again makes the same run")
        browser.run("URL.createObjectURL = (blob) => { window.blob = blob; return 'data:,'; }; document.getElementById('save-picture').click()")
        size = browser.wait("window.blob") and browser.call("POST", "/execute/async", {"script": PICTURE, "args": []})
        shown = browser.run("const m = document.querySelector('main'); return [2 * m.clientWidth, 2 * m.scrollHeight]")
        checks.check(size and size[:2] == shown and size[2] > 50 and size[3], "save-picture saves what is shown", f"{size} {shown}")
        browser.run("document.getElementById('copy-sweep').click()")
        table = eval(browser.run("return document.getElementById('copied').textContent"), {"gudgeon": gudgeon})
        checks.check(len(table) == 11 and table["contact.dissipation"].is_monotonic_increasing, "and a sweep over the last slider", str(table.columns[:3]))

        # wrong values: the program's words, and the last picture stays
        image = browser.run(CHART)
        for typed in ("-5", "abc"):
            browser.run(TYPE, key, typed)
            checks.check(browser.wait("document.querySelector('.wrong')") and key.partition(".")[2] in page.failure(), f"{typed} is refused", page.failure())
            checks.check(browser.run("return document.querySelector('.wrong').dataset.key") == key, "its box is marked")
        checks.check(browser.run(CHART) == image, "the last picture stays")
        said = browser.run(TYPE + FAILURE, key, "5 mm")
        checks.check(said == "" and browser.run("return !document.querySelector('.wrong')"), "a right value ends the message before its run has ended", said)
        browser.wait(READY)
        checks.check(page.moved("document.getElementById('reset').click()") and page.failure() == "", "reset returns to the case")
        checks.check(browser.run("return Object.keys(explorer.values).length") == 0, "without any value of its own")

        # a key that is added, and the address
        browser.run("const e = document.getElementById('more'); e.value = 'friction.coefficient'; e.dispatchEvent(new Event('change'))")
        checks.check(browser.wait("document.querySelector('[data-key=\"friction.coefficient\"]')"), "a key is added")
        written = f"location.hash === '#{key}=' + explorer.values['{key}']"
        page.moved(SLIDE, key, 0.3)
        checks.check(browser.wait(written), "the address has the values")
        value = browser.run(f"return explorer.values['{key}']")
        page.moved(SLIDE, key, 0.6)
        browser.wait(written)
        checks.check(page.moved("history.back()") and browser.run(f"return explorer.values['{key}']") == value, "the browser's back runs the values before")
        # certificate, small screen
        checks.check(page.moved("document.getElementById('certify').click()"), "certify runs")
        checks.check("Certified" in browser.run("return document.getElementById('notes').textContent"), "and tells digits")
        loose = browser.run("return [...document.querySelectorAll('#answers .loose')].map(e => e.textContent)")
        checks.check(loose and len(loose) < len(browser.run(ANSWERS)) + 3, "digits that are not certified are grey", str(loose))
        checks.check((width := browser.width_at(390)) == 390, f"on a phone it is {width} wide instead of 390")
        browser.width_at(0)
        browser.run("document.querySelector('#charts canvas').click()")
        checks.check(browser.wait("document.querySelector('#zoomed .main-svg')"), "a curve opens large")
        browser.run("document.getElementById('zoom').close()")
        checks.check(page.moved("document.querySelector(`[data-key='joint.clearance'] label`).dispatchEvent(new MouseEvent('dblclick', {bubbles: true}))")
                     and key not in browser.run("return explorer.values"), "a double click resets one slider")
        checks.check(not (said := [one for one in browser.messages() if "403" not in one]), f"console: {said}")


def check_drag(browser: Browser, checks: Assertions, pictures: Path | None) -> None:
    """60 positions of a slider in two seconds, on a slow machine more: pictures on the way, and the last value at the end."""
    with served(Explorer(gudgeon.template("engine"))) as server:
        page = Page(browser, server.address)
        page.settled()
        browser.run("explorer.drawing.seek(0.3 * explorer.drawing.begin + 0.7 * explorer.drawing.end)")
        for key, part in (("joint.clearance", 0.2), ("initial.crank_speed", 0.7)):
            before = browser.run(ANGLE)
            page.moved(SLIDE, key, part)
            checks.check(abs(browser.run(ANGLE) - before) < 0.01, "the animation keeps its crank angle", f"{key}: {before}, {browser.run(ANGLE)}")
        page.moved("document.getElementById('reset').click()")
        browser.run("document.getElementById('keep').click()")
        count = browser.run("return explorer.runs.length")
        browser.run("""window.drag = 0; const e = document.querySelector('[data-key="joint.clearance"] [type=range]');
            window.timer = setInterval(() => { e.value = 40 + 2 * (window.drag++ % 60); e.dispatchEvent(new Event('input', {bubbles: true}));
              if (window.drag >= 60 && explorer.runs.length > arguments[0] + 2) { clearInterval(window.timer); window.dragged = true; } }, 33);""", count)
        browser.wait("window.dragged")
        made = browser.run("return explorer.runs.length") - count
        milliseconds = browser.run(f"return explorer.runs.slice({count}).map(run => Math.round(run.ms))")
        checks.check(page.settled() and made > 2, "pictures in a drag", f"{made}: {milliseconds}")
        last = "explorer.values['joint.clearance']"
        checks.check(browser.wait(f"explorer.shown.values['joint.clearance'] === {last} && !explorer.shown.head.draft"), "the drag ends at its last value, in full")
        checks.check(same_rows(page, server.explorer.case.set(browser.run("return explorer.values")).run(), "film_thickness"), "whose film is that of the library")
        if pictures:
            browser.screenshot(pictures / "explore.png")
        for width in (800, 390):
            found = browser.width_at(width), *browser.run("const m = document.querySelector('main'); return [m.scrollWidth, m.clientWidth]")
            checks.check(found[0] == width and found[1] == found[2], f"with kept runs a page of {width} is {found} wide")
        browser.width_at(0)


def check_films(browser: Browser, checks: Assertions) -> None:
    """A film with a table of its own: a draft first, then the run in full; a run that fails; one that is stopped; another law."""
    case = gudgeon.template("film")
    case["lubrication.law"] = "finite_bearing"
    with tempfile.TemporaryDirectory() as cache:
        case.cache(cache)
        with served(Explorer(case)) as server:
            page = Page(browser, server.address)
            checks.check(browser.wait("window.explorer && explorer.shown") and browser.run("return explorer.shown.head.draft"), "a draft comes first")
            checks.check("draft" in browser.run("return document.getElementById('answers').className"), "and is grey")
            draft = browser.run(ANSWERS)
            checks.check(page.settled() and browser.run("return document.getElementById('answers').className") == "", "the run in full follows")
            checks.check(draft.keys() == browser.run(ANSWERS).keys(), "with the same answers")
            checks.check(same_rows(page, case.run(), "film_thickness"), "its film is that of case.run()")
            count = browser.run("return explorer.runs.length")
            browser.run(SLIDE, "joint.clearance", 0.6)
            checks.check(browser.wait(f"explorer.runs.length > {count}") and not browser.run("return explorer.shown.head.draft"), "with its table there are no drafts")
    case = case_of_readme()
    with served(Explorer(case)) as server:
        page = Page(browser, server.address)
        page.settled()
        browser.run("const e = document.getElementById('more'); e.value = 'lubrication.law'; e.dispatchEvent(new Event('change'))")
        browser.wait("document.querySelector('[data-key=\"lubrication.law\"]')")
        checks.check(page.moved(TYPE, "lubrication.law", "oscillating_film") and "left its bearing" in page.failure(), "a run that fails is told", page.failure())
        checks.check("draft" in browser.run("return document.getElementById('answers').className") and browser.run(PAINTED, "orbit"), "with its rows, and answers in grey")
    case = gudgeon.template("dry")
    case["integrator.revolutions"] = 20000
    with served(Explorer(case, timeout=1.0)) as server:
        page = Page(browser, server.address)
        checks.check(browser.wait("window.explorer && !document.getElementById('busy').hidden"), "a long run shows its clock")
        checks.check(page.settled() and "--timeout" in page.failure(), "the limit of time is told", page.failure())
        checks.check("draft" in browser.run("return document.getElementById('answers').className"), "answers of a part are grey")
        server.explorer.timeout = 100.0
        browser.run(SLIDE, "joint.clearance", 0.4)
        browser.wait("!document.getElementById('busy').hidden")
        browser.run("document.getElementById('stop').click()")
        checks.check(browser.run("return document.getElementById('busy').hidden"), "a run is stopped")
        server.explorer.case["integrator.revolutions"] = 4
        checks.check(page.moved(SLIDE, "joint.clearance", 0.5), "and the next one runs")
        other = "impact"
        browser.run(TYPE, "contact.law", other)
        gone = "!document.querySelector('[data-key=\"contact.dissipation\"]')"
        checks.check(browser.wait(gone), f"a law without dissipation ({other}) has no slider of it", page.failure())
        names = [name for name, key in gudgeon.keys.items() if key.group == "contact" and other in key.laws and server.explorer.control(server.explorer.changed({"contact.law": other}), name)]
        checks.check(names and browser.run("return arguments[0].every(name => document.querySelector(`[data-key='${name}']`))", names), "and has those of its own", str(names))


def check_many_answers(browser: Browser, checks: Assertions) -> None:
    """Three bearings on a screen of 1400 x 900: answers and curves are seen together, also beside a kept run; the print has no controls."""
    with served(Explorer(gudgeon.read(TOP / "cases" / "bearings" / "car_diesel.nml"))) as server:
        browser.cdp("Emulation.setDeviceMetricsOverride", width=1400, height=900, deviceScaleFactor=1, mobile=False)
        page = Page(browser, server.address)
        checks.check(page.settled(60) and len(browser.run(ANSWERS)) >= 18, "answers of three bearings")
        for kept in (0, 1):
            ends = browser.run("return [...document.querySelectorAll('#charts figure, #mechanism')].map(e => e.getBoundingClientRect().bottom)")
            checks.check(len(ends) >= 6 and max(ends) <= 900, f"are seen with all curves and the mechanism, {kept} kept", str(ends))
            browser.run("document.getElementById('keep').click()")
        browser.cdp("Emulation.setEmulatedMedia", media="print")
        shown = browser.run("return [...document.querySelectorAll('button, input, select')].filter(e => e.getClientRects().length).map(e => e.id || e.textContent)")
        checks.check(shown == [] and browser.run("return document.getElementById('answers').getClientRects().length") == 1, "the print has no controls", str(shown))
        cut = browser.run("return [...document.querySelectorAll('main, #top')].filter(e => e.scrollHeight > e.clientHeight + 1).map(e => e.tagName)")
        checks.check(cut == [], "and nothing in it is cut", str(cut))
        browser.cdp("Emulation.setEmulatedMedia", media="")
        browser.width_at(0)


def check_frame_and_language(browser: Browser, checks: Assertions) -> None:
    """In a frame of another port of this machine, as a notebook shows it; in Portuguese."""
    with served(Explorer(gudgeon.template("dry"), language=Language("pt"))) as server:
        page = Page(browser, server.address)
        checks.check(page.settled(), "Portuguese: opens")
        text = browser.run("return document.body.innerText")
        key = "joint.clearance"
        checks.check(page.moved(TYPE, key, "14,5 um") and page.failure() == "" and browser.run(f"return explorer.values['{key}']") == 14.5e-6, "Portuguese: a decimal comma with a unit", page.failure())
        checks.check("manter" in text and "reproduzir" in text and server.explorer.language.unknown == set(), "Portuguese texts", str(server.explorer.language.unknown))
        session = gudgeon.template("dry").explore()

        class Notebook(http.server.BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                self.send_response(200)
                self.end_headers()
                self.wfile.write(f"<html><link rel=icon href=data:,>{session._repr_html_()}</html>".encode())

            def log_message(self, *_: object) -> None:
                pass

        notebook = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Notebook)
        threading.Thread(target=notebook.serve_forever, daemon=True).start()
        browser.call("POST", "/url", {"url": f"http://localhost:{notebook.server_port}/"})
        element = browser.call("POST", "/element", {"using": "css selector", "value": "iframe"})
        browser.call("POST", "/frame", {"id": element})
        checks.check(browser.wait(READY), "a frame of a notebook shows the page")
        browser.call("POST", "/frame", {"id": None})
        notebook.shutdown()
        session.close()


def picture_in_portuguese(browser: Browser, picture: Path) -> None:
    """The explorer in Portuguese with two clearances of an engine."""
    with served(Explorer(gudgeon.template("engine"), language=Language("pt"))) as server:
        page = Page(browser, server.address)
        page.settled()
        browser.run("explorer.drawing.seek(0.3 * explorer.drawing.begin + 0.7 * explorer.drawing.end); document.getElementById('keep').click()")
        page.moved(SLIDE, "joint.clearance", 0.6)
        browser.screenshot(picture)
        fewer_colours(picture)


def check_keyboard(browser: Browser, checks: Assertions) -> None:
    """Everything by keys alone: Tab reaches all controls, arrows move a slider, k keeps a run, Enter opens a curve, Escape closes it."""
    def press(*keys: str) -> None:
        actions = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        browser.call("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": actions}]})

    tab, down, left, enter, escape = "\ue004", "\ue015", "\ue012", "\ue007", "\ue00c"
    focused = "const e = document.activeElement; return e.id || e.closest('[data-key]')?.dataset.key || e.closest('figure')?.dataset.title || e.tagName"
    with served(Explorer(gudgeon.template("engine"))) as server:
        page = Page(browser, server.address)
        page.settled()
        wanted = {"keep", "reset", "certify", "more", "copy-set", "copy-python", "copy-sweep", "save-case", "save-csv", "save-page", "save-picture", "play", "scrub", "speed", "magnification",
                  *browser.run("return [...document.querySelectorAll('.slider')].map(e => e.dataset.key)"), *browser.run("return explorer.shown.scene.plots.map(p => p.title)")}
        reached: list[str] = []
        for _ in range(3 * len(wanted)):
            press(tab)
            reached.append(browser.run(focused))
            if reached[-1] == "joint.clearance" and browser.run("return document.activeElement.type") == "range" and not browser.run("return 'joint.clearance' in explorer.values"):
                count = browser.run("return explorer.runs.length")
                press(left)
                checks.check(browser.wait(f"explorer.runs.length > {count}") and browser.run("return 'joint.clearance' in explorer.values"), "an arrow moves the slider")
                press("k")
                checks.check(browser.run("return explorer.kept.length") == 1, "k keeps the run")
        checks.check(wanted <= set(reached), "Tab reaches all controls", str(wanted - set(reached)))
        browser.run("document.querySelector('#charts canvas').focus()")
        press(enter)
        checks.check(browser.wait("document.querySelector('#zoomed .main-svg')"), "Enter opens a curve")
        press(escape)
        checks.check(browser.wait("!document.getElementById('zoom').open"), "Escape closes it")
        browser.run("document.querySelector('[data-key=\"combustion.cycle\"] select').focus()")
        press("k", down)
        checks.check(browser.wait("explorer.values['combustion.cycle'] === 'two_stroke'") and browser.run("return explorer.kept.length") == 1, "a letter in a menu keeps no run")


def check_memory(browser: Browser, checks: Assertions, changes: int) -> None:
    """Many changes: heap of the browser, memory of the server in a process of its own, waiting from slider to picture."""
    process = subprocess.Popen([sys.executable, "-m", "gudgeon", "explore", "film", "--no-browser"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)

    def used() -> tuple[float, float]:
        browser.cdp("HeapProfiler.collectGarbage")
        resident = next(line for line in Path(f"/proc/{process.pid}/status").read_text().splitlines() if line.startswith("VmRSS"))
        return browser.cdp("Runtime.getHeapUsage")["usedSize"] / 1e6, int(resident.split()[1]) / 1e3

    try:
        page = Page(browser, process.stdout.readline().strip())
        page.settled()
        browser.run("document.getElementById('keep').click()")
        first = used()
        browser.run("""window.done = 0; const e = document.querySelector('[data-key="joint.clearance"] [type=range]');
            (async () => { while (window.done < arguments[0]) { const count = explorer.runs.length; e.value = 20 + (37 * window.done) % 160; e.dispatchEvent(new Event('input', {bubbles: true}));
              while (explorer.runs.length === count) await new Promise(next => setTimeout(next, 5)); window.done++; } })();""", changes)
        checks.check(browser.wait(f"window.done === {changes}", 120 + changes), f"{changes} changes")
        last, times = used(), sorted(browser.run("return explorer.runs.map(run => run.ms)"))
        said = f"heap {first[0]:.1f} -> {last[0]:.1f} MB, server {first[1]:.0f} -> {last[1]:.0f} MB, median {times[len(times) // 2]:.0f} ms, p95 {times[int(0.95 * len(times))]:.0f} ms"
        print(f"{changes} changes: {said}")
        checks.check(last[0] < 20, f"heap of the browser after {changes} changes", said)
        checks.check(last[1] < 250, f"memory of the server after {changes} changes", said)
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(10)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--screenshots", type=Path, metavar="DIR")
    parser.add_argument("--program", type=Path, metavar="GUDGEON")
    parser.add_argument("--changes", type=int, metavar="N")
    options = parser.parse_args()
    chromium, driver = shutil.which("chromium") or shutil.which("chromium-browser"), shutil.which("chromedriver")
    if not chromium or not driver:
        print("Chromium is not installed: scripts/setup.sh --browser (or apt-get install chromium chromium-driver)\n0 passed, 1 failed")
        return 1
    if options.screenshots:
        options.screenshots.mkdir(parents=True, exist_ok=True)
    checks = Assertions()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as work:   # Chromium may still be writing
        browser = Browser(chromium, driver, work)
        try:
            check_memory(browser, checks, options.changes or 60)
            if options.changes:
                return checks.report()
            check_notes(browser, checks)
            check_pages(browser, checks)
            check_keyboard(browser, checks)
            check_sliders(browser, checks, (options.program or release_program()).resolve())
            check_drag(browser, checks, options.screenshots)
            check_films(browser, checks)
            check_many_answers(browser, checks)
            check_frame_and_language(browser, checks)
            if options.screenshots:
                picture_in_portuguese(browser, options.screenshots / "explore_pt.png")
        finally:
            browser.close()
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
