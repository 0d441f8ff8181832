#!/usr/bin/env python3
"""Opens pages of gudgeon-plot explore in headless Chromium: sliders run the case, what is drawn is what the library computes, wrong and slow
cases are told, kept runs stay, values leave; and asks its server what it must refuse.

    tests/test_explore.py [--screenshots DIR] [--program GUDGEON]

Needs the library (scripts/python/build_library.py), the program, and chromium and chromium-driver, without which the test fails.
Ends with the line "N passed, N failed".
"""

import argparse
import contextlib
import http.client
import http.server
import json
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse
from collections.abc import Iterator
from pathlib import Path

import gudgeon
import numpy as np
from assertions import Assertions
from gudgeon.language import Language
from gudgeon.program import release_program
from gudgeon.report.explorer import LARGEST_REQUEST, Explorer, Server, slider_range
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


@contextlib.contextmanager
def served(explorer: Explorer) -> Iterator[Server]:
    """An explorer in a thread of this process."""
    server = Server(explorer)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield server
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


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

    def settled(self, seconds: float = 30) -> bool:
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
            size = len(server.explorer.html(""))
            checks.check(size < 80_000, f"{case.name}: the page has {size} bytes")
            head, data = server.explorer.scene(case.run())
            size = len(json.dumps(head)) + sum(map(len, data.values()))
            checks.check(size < 400_000, f"{case.name}: a run has {size} bytes")


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
            done = subprocess.run(words.replace("gudgeon", f"{program} -q -o {work}", 1), shell=True, cwd=work, capture_output=True, text=True, check=False)
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

        # wrong values: the program's words, and the last picture stays
        image = browser.run(CHART)
        for typed in ("-5", "abc"):
            browser.run(TYPE, key, typed)
            checks.check(browser.wait("document.querySelector('.wrong')") and key.partition(".")[2] in page.failure(), f"{typed} is refused", page.failure())
            checks.check(browser.run("return document.querySelector('.wrong').dataset.key") == key, "its box is marked")
        checks.check(browser.run(CHART) == image, "the last picture stays")
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
        checks.check((width := browser.width_at(390)) == 390, f"on a phone it is {width} wide instead of 390")
        browser.width_at(0)
        browser.run("document.querySelector('#charts canvas').click()")
        checks.check(browser.wait("document.querySelector('#zoomed .main-svg')"), "a curve opens large")
        checks.check(not (said := [one for one in browser.messages() if "403" not in one]), f"console: {said}")


def check_drag(browser: Browser, checks: Assertions, pictures: Path | None) -> None:
    """60 positions of a slider in two seconds: pictures on the way, and the last value at the end."""
    with served(Explorer(gudgeon.template("engine"))) as server:
        page = Page(browser, server.address)
        page.settled()
        browser.run("document.getElementById('keep').click()")
        count = browser.run("return explorer.runs.length")
        browser.run("""window.drag = 0; const e = document.querySelector('[data-key="joint.clearance"] [type=range]');
            window.timer = setInterval(() => { e.value = 40 + 2 * window.drag; e.dispatchEvent(new Event('input', {bubbles: true})); if (++window.drag === 60) clearInterval(window.timer); }, 33);""")
        browser.wait("window.drag === 60")
        made = browser.run("return explorer.runs.length") - count
        milliseconds = browser.run(f"return explorer.runs.slice({count}).map(run => Math.round(run.ms))")
        checks.check(page.settled() and made > 10, f"pictures in a drag: {made}", str(milliseconds))
        last = "explorer.values['joint.clearance']"
        checks.check(browser.wait(f"explorer.shown.values['joint.clearance'] === {last} && !explorer.shown.head.draft"), "the drag ends at its last value, in full")
        checks.check(same_rows(page, server.explorer.case.set({"joint.clearance": browser.run(f"return {last}")}).run(), "film_thickness"), "whose film is that of the library")
        if pictures:
            browser.screenshot(pictures / "explore.png")


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
        words = gudgeon.keys["contact.law"].words
        other = next(word for word in words if word != case["contact.law"] and word not in gudgeon.keys["contact.dissipation"].laws)
        browser.run(TYPE, "contact.law", other)
        gone = "!document.querySelector('[data-key=\"contact.dissipation\"]')"
        checks.check(browser.wait(gone), f"a law without dissipation ({other}) has no slider of it", page.failure())


def check_frame_and_language(browser: Browser, checks: Assertions) -> None:
    """In a frame of another port of this machine, as a notebook shows it; in Portuguese."""
    with served(Explorer(gudgeon.template("dry"), language=Language("pt"))) as server:
        page = Page(browser, server.address)
        checks.check(page.settled(), "Portuguese: opens")
        text = browser.run("return document.body.innerText")
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


def asked(server: Server, path: str, body: bytes | None = None, **headers: str) -> tuple[int, bytes]:
    """Status and content of an answer; a header whose value is empty is left out."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=30)
    given = {"Host": f"127.0.0.1:{server.server_port}", "X-Token": server.token, **{name.replace("_", "-"): value for name, value in headers.items()}}
    connection.request("GET" if body is None else "POST", path, body, {name: value for name, value in given.items() if value})
    answer = connection.getresponse()
    content = answer.read()
    connection.close()
    return answer.status, content


def head_of(content: bytes) -> dict:
    return json.loads(content[4 : 4 + struct.unpack("<I", content[:4])[0]])


def check_server(checks: Assertions) -> None:
    """What the server refuses, and two pages at once."""
    case = gudgeon.template("dry")
    with served(Explorer(case)) as server:
        question = json.dumps({"page": "a", "request": 1, "values": {}, "tier": "live"}).encode()
        for what, wanted, path, body, headers in (
            ("the page", 200, f"/?token={server.token}", None, {}), ("a run", 200, "/run", question, {}),
            ("no token", 403, "/", None, {}), ("another token", 403, "/?token=x", None, {}), ("a run without token", 403, "/run", question, {"X_Token": ""}),
            ("another host", 403, "/run", question, {"Host": "example.org"}), ("another origin", 403, "/run", question, {"Origin": "http://example.org"}),
            ("no origin of a file", 403, "/run", question, {"Origin": "null"}), ("another name of this machine", 200, "/run", question, {"Host": "localhost:9999"}),
            ("another path", 404, "/etc/passwd", question, {}), ("another page", 404, f"/../?token={server.token}", None, {}),
            ("a large question", 413, "/run", b" " * (LARGEST_REQUEST + 1), {}),
        ):  # fmt: skip
            status, content = asked(server, path, body, **headers)
            checks.check(status == wanted, f"{what}: {wanted}", f"{status} {content[:80]!r}")
        for what, values, words in (("a text", {"case.title": "x"}, "texts and tables"), ("no key", {"joint.clearence": 1}, "clearence"), ("no JSON object", [1], "")):
            status, content = asked(server, "/run", json.dumps({"page": "b", "request": 1, "values": values, "tier": "live"}).encode())
            checks.check(status == 200 and words in head_of(content).get("error", ""), f"{what} is refused", str(content[:200]))
        status, content = asked(server, "/run", b"{")
        checks.check(status == 200 and "error" in head_of(content), "no JSON is refused")
        found: dict[str, dict] = {}
        values = {"a": 2e-5, "b": 4e-5}

        def ask(page: str) -> None:
            body = json.dumps({"page": page, "request": 2, "values": {"joint.clearance": values[page]}, "tier": "live"}).encode()
            found[page] = head_of(asked(server, "/run", body)[1])

        threads = [threading.Thread(target=ask, args=(page,)) for page in values]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        checks.check({page: head["scene"]["clearance"] for page, head in found.items()} == values, "two pages have their own runs")
        late = json.dumps({"page": "a", "request": 1, "values": {}, "tier": "live"}).encode()
        checks.check(head_of(asked(server, "/run", late)[1]).get("superseded"), "an older request is superseded")


def check_shipped_cases(checks: Assertions) -> None:
    """Films of a skirt and of three bearings, several cylinders, a floating pin, a worn bore: their runs can be drawn."""
    for name in ("joints/skirt", "bearings/car_diesel", "cylinders/six_mwm", "pin/engine", "wear/worn_bore", "film/heat"):
        path = TOP / "cases" / f"{name}.nml"
        explorer = Explorer(gudgeon.read(path), timeout=2.0)
        head = head_of(explorer.run("a", 1, {}, "live"))
        checks.check(head["scene"]["rows"] > 100 and len(head["answers"]) > 1 and len(explorer.controls()) > 5, f"{name} is drawn", str(head.get("error")))


def check_command(checks: Assertions) -> None:
    """The command: its address, Ctrl-C while a table is made, a port in use, wrong words."""
    def begun(*words: str) -> subprocess.Popen:
        return subprocess.Popen([sys.executable, "-m", "gudgeon", "explore", *words, "--no-browser"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "film.nml")
        gudgeon.template("film").set({"lubrication.law": "finite_bearing"}).to_nml(path)
        began = time.monotonic()
        process = begun(str(path), "--set", "joint.clearance=31 um")
        address = process.stdout.readline().strip()
        seconds = time.monotonic() - began
        checks.check(address.startswith("http://127.0.0.1:"), "prints its address", address)
        checks.check(seconds < 5, f"the address is there after {seconds:.1f} s")
        parts = urllib.parse.urlsplit(address)
        connection = http.client.HTTPConnection("127.0.0.1", parts.port, timeout=30)
        body = json.dumps({"page": "a", "request": 1, "values": {}, "tier": "full"})
        connection.request("POST", "/run", body, {"X-Token": parts.query.removeprefix("token=")})
        time.sleep(0.3)
        second = begun(str(path), "--port", str(parts.port))
        said = second.communicate(timeout=30)[1]
        checks.check(second.returncode == 1 and f"port {parts.port}" in said, "a port in use is told", said)
        process.send_signal(signal.SIGINT)
        try:
            status = process.wait(10)
        except subprocess.TimeoutExpired:
            status = None
            process.kill()
        said = process.stderr.read()
        checks.check(status == 0 and "Traceback" not in said, "Ctrl-C ends it", f"{status} {said}")
        checks.check("ssh -L" in said, "tells how to reach it from another machine")
        alone = TOP / "cases" / "bearings" / "main_bearing.nml"
        for words, wanted in (((str(alone),), "has no mechanism"), (("nothing",), "no template nothing"), ((str(path), "--keys", "joint.x"), "no key joint.x"), ((str(path), "--set", "joint.clearance=-1"), "clearance")):
            process = begun(*words)
            said = process.communicate(timeout=30)[1]
            checks.check(process.returncode == 2 and wanted in said and "Traceback" not in said, f"{words[-1]} is refused", said)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--screenshots", type=Path, metavar="DIR")
    parser.add_argument("--program", type=Path, metavar="GUDGEON")
    options = parser.parse_args()
    chromium, driver = shutil.which("chromium") or shutil.which("chromium-browser"), shutil.which("chromedriver")
    if not chromium or not driver:
        print("Chromium is not installed: scripts/setup.sh --browser (or apt-get install chromium chromium-driver)\n0 passed, 1 failed")
        return 1
    if options.screenshots:
        options.screenshots.mkdir(parents=True, exist_ok=True)
    checks = Assertions()
    check_server(checks)
    check_shipped_cases(checks)
    check_command(checks)
    with tempfile.TemporaryDirectory() as work:
        browser = Browser(chromium, driver, work)
        try:
            check_pages(browser, checks)
            check_sliders(browser, checks, (options.program or release_program()).resolve())
            check_drag(browser, checks, options.screenshots)
            check_films(browser, checks)
            check_frame_and_language(browser, checks)
        finally:
            browser.close()
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
