#!/usr/bin/env python3
"""Asks the server of gudgeon-plot explore what it must refuse and what two pages get, without a browser; and its command: address, Ctrl-C
while a table is made, a port in use, wrong words, a machine without a display.

    tests/test_explore_server.py

Needs the library (scripts/python/build_library.py). Ends with the line "N passed, N failed".
"""

import contextlib
import http.client
import json
import os
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
from assertions import Assertions
from gudgeon.report.explorer import LARGEST_REQUEST, Explorer, Server

TOP = Path(__file__).resolve().parents[1]

#: Seconds for what takes one or two on a quiet machine.
ROOM = 60.0


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


def asked(server: Server, path: str, body: bytes | None = None, **headers: str) -> tuple[int, bytes]:
    """Status and content of an answer; a header whose value is empty is left out."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=ROOM)
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
        explorer = Explorer(gudgeon.read(path), timeout=ROOM)
        head = head_of(explorer.run("a", 1, {}, "live"))
        checks.check(head["scene"]["rows"] > 100 and len(head["answers"]) > 1 and len(explorer.controls()) > 5, f"{name} is drawn", str(head.get("error")))


def check_command(checks: Assertions) -> None:
    """The command: its address, Ctrl-C while a table is made, a port in use, wrong words."""
    with tempfile.TemporaryDirectory() as folder:
        headless = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")} | {"XDG_CACHE_HOME": folder}

        def begun(*words: str) -> subprocess.Popen:
            return subprocess.Popen([sys.executable, "-m", "gudgeon", "explore", *words], env=headless, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

        path = Path(folder, "film.nml")
        gudgeon.template("film").set({"lubrication.law": "finite_bearing", "lubrication.table_points": 513}).to_nml(path)   # a table of half a minute
        began = time.monotonic()
        process = begun(str(path), "--set", "joint.clearance=31 um")
        address = process.stdout.readline().strip()
        seconds = time.monotonic() - began
        checks.check(address.startswith("http://127.0.0.1:"), "without a display it prints its address", address)
        checks.check(seconds < ROOM, f"the address is there after {seconds:.1f} s")
        parts = urllib.parse.urlsplit(address)
        connection = http.client.HTTPConnection("127.0.0.1", parts.port, timeout=ROOM)
        body = json.dumps({"page": "a", "request": 1, "values": {}, "tier": "full"})
        connection.request("POST", "/run", body, {"X-Token": parts.query.removeprefix("token=")})
        time.sleep(0.3)
        checks.check(not list(Path(folder).rglob("*.table")), "its table is being made")
        second = begun(str(path), "--port", str(parts.port))
        said = second.communicate(timeout=ROOM)[1]
        checks.check(second.returncode == 1 and f"port {parts.port}" in said, "a port in use is told", said)
        process.send_signal(signal.SIGINT)
        try:
            status = process.wait(ROOM / 2)
        except subprocess.TimeoutExpired:
            status = None
            process.kill()
        said = process.stderr.read()
        checks.check(status == 0 and "Traceback" not in said, "Ctrl-C ends it", f"{status} {said}")
        checks.check(not list(Path(folder).rglob("*.table")), "before its table is complete")
        checks.check("ssh -L" in said, "tells how to reach it from another machine")
        alone = TOP / "cases" / "bearings" / "main_bearing.nml"
        for words, wanted in (((str(alone),), "has no mechanism"), (("nothing",), "no template nothing"), ((str(path), "--keys", "joint.x"), "no key joint.x"), ((str(path), "--set", "joint.clearance=-1"), "clearance")):
            process = begun(*words)
            said = process.communicate(timeout=ROOM)[1]
            checks.check(process.returncode == 2 and wanted in said and "Traceback" not in said, f"{words[-1]} is refused", said)


def main() -> int:
    checks = Assertions()
    check_server(checks)
    check_shipped_cases(checks)
    check_command(checks)
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
