"""The explorer: a page whose sliders run a case. It is served to this machine alone, and to those who know its token.

The page asks by POST, with its token in X-Token and a JSON object: its number of this page (`page`) and of this request (`request`), and
the `values` of keys that differ from the case. Answers are JSON, text, or for /run the length of a head in four bytes, the head as JSON
and the bytes of `scene_of`.
"""

import dataclasses
import gzip
import hmac
import http.server
import json
import math
import re
import secrets
import socketserver
import struct
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import gudgeon
from gudgeon._keys import Key
from gudgeon.language import Language

LARGEST_REQUEST = 100_000  # bytes
SLIDER_RANGE = 5.0  # of a value, up and down, within the usual range of its key
MOST_ROWS = 2000

#: What is on a slider from the beginning: all numbers and words that the case gives, but for these.
HIDDEN = re.compile(r"(integrator|output|run|case)\.|initial\.crank_angle")

#: Those that are changed most come first.
FIRST = [re.compile(part) for part in (
    r"clearance$", r"\.oil$", r"viscosity$", r"temperature$", r"initial\.crank_speed$", r"restitution$", r"contact\.", r"friction\.", r"guide\.", r"combustion\.|cylinder_pressure\.|gas\.",
)]  # fmt: skip

#: On what a film's table depends: it moves to other clearances and viscosities in some milliseconds.
TABLE = re.compile(r"bearing_(length|radius)|lubrication\.(law|variant|cavitation|film_points|table_file)|relative_tolerance")

#: Oils of the menu; any other name can be set in the case.
OILS = ("ISO VG 32", "ISO VG 46", "ISO VG 68", "ISO VG 100", "SAE 10W", "SAE 20", "SAE 30", "SAE 40", "SAE 50", "0W-20", "5W-30", "10W-40", "15W-40")

#: Units of keys, and what is shown: unit, factor and offset.
SHOWN = {"K": ("°C", 1.0, -273.15), "rad/s": ("rpm", 30 / math.pi, 0.0), "Pa s": ("mPa s", 1e3, 0.0), "m^2/s": ("mm²/s", 1e6, 0.0), "degrees": ("°", 1.0, 0.0)}

#: The same for values of at least a size, of which the first is taken: unit, factor and this size.
SIZES = {"kg": (("t", 1e-3, 1e4), ("kg", 1.0, 0.1), ("g", 1e3, 1e-4), ("mg", 1e6, 0.0)), "kg m^2": (("kg m²", 1.0, 1e-3), ("kg mm²", 1e6, 1e-6), ("g mm²", 1e9, 0.0)),
         "m^2": (("m²", 1.0, 0.1), ("cm²", 1e4, 1e-5), ("mm²", 1e6, 0.0)), "J": (("kJ", 1e-3, 1e4), ("J", 1.0, 0.0))}  # fmt: skip

#: Curves over the crank angle; that of the gas is a p-V diagram.
CURVES = re.compile(r"(\w+_)?(film_thickness|normal_force)|pin_force|piston_acceleration|crank_speed|guide_force|cylinder_pressure")

HEADERS = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Content-Security-Policy": "default-src 'none'; script-src 'self' 'unsafe-inline'; style-src 'unsafe-inline'; connect-src 'self'; img-src data: blob:;"
    " frame-ancestors 'self' http://localhost:* http://127.0.0.1:*",
}
LOCAL = ("localhost", "127.0.0.1", "[::1]")


class Superseded(Exception):
    """The page has asked for something newer."""


def shown_unit(of_key: str, value: float) -> tuple[str, float, float]:
    """Unit in which pages show a value of this size and unit of a key, and factor and offset to it."""
    from gudgeon.names import plain_unit

    if of_key == "m":
        return ("µm", 1e6, 0.0) if abs(value) < 5e-4 else ("mm", 1e3, 0.0)
    if of_key == "Pa":
        return ("bar", 1e-5, 0.0) if abs(value) < 1e7 else ("MPa", 1e-6, 0.0)
    if fitting := [(unit, factor, 0.0) for unit, factor, least in SIZES.get(of_key, ()) if abs(value) >= least]:
        return fitting[0]
    return SHOWN.get(of_key, (plain_unit(of_key), 1.0, 0.0))


def slider_range(key: Key, value: float) -> tuple[float, float]:
    """Least and largest value of the slider of a key: the usual ones, not far from the value, and such as the key may have."""
    least, most, with_least, _ = key.bounds
    low, high = (float(part) for part in key.usual.split(" to ")) if key.usual else (-math.inf, math.inf)
    near = sorted((value / SLIDER_RANGE, value * SLIDER_RANGE)) if value else (low if math.isfinite(low) else 0.0, high if math.isfinite(high) else 1.0)
    low, high = max(low, near[0], least), min(high, near[1], most)
    low, high = min(low, value), max(high, value)
    return (low if with_least or low > least else low + 1e-3 * (high - low)), high


def of_cycle(run: Any) -> Any:
    """The last whole cycle of a run of `gudgeon.results`, with the contacts that begin in it; the run itself without one."""
    from gudgeon.report.scene import last_cycle

    time = run["time"]
    cycle = last_cycle(run, {"time": time, "crank_angle": run["crank_angle"]})
    if cycle is None:
        return run
    begin, end = (cycle[name] + sign * 1e-4 * (cycle["end"] - cycle["begin"]) for name, sign in (("begin", -1), ("end", 1)))
    rows = (time >= begin) & (time <= end)
    begun = run.events["time"] - run.events["duration"].fillna(0)
    return dataclasses.replace(run, trace=run.trace[rows].reset_index(drop=True), events=run.events[(begun >= begin) & (begun <= end)])


def answers_of(run: Any, say: Callable[[str], str]) -> list[tuple[str, str]]:
    """Names and HTML of the answers of a run of `gudgeon.results`, each name once; a numbered bearing has one line."""
    from gudgeon.report import answers

    (places, of_bearings, of_machine), (_, numbered) = answers.lines(run), answers.of_numbered(run)
    found = [(say(name) + (f", {say(place)}" if len(places) > 1 or numbered else ""), say(text))
             for name, texts in of_bearings for place, text in zip(places, texts) if text]  # fmt: skip
    found += [(say(name), say(text)) for name, text in of_machine]
    found += [(say(name), ", ".join(say(text) for text in texts if text)) for name, texts in numbered]
    return [(name, answers.html_of(text)) for name, text in found]


class Explorer:
    """Runs of a case with other values. `source` makes the case in Python; `words` of the command line run it; `names`: the keys on
    sliders instead of those that the case gives; `timeout` [s] of runs that follow a slider. Raises CaseError for a bearing by itself."""

    def __init__(
        self, case: gudgeon.Case, source: str = "case", words: str = "CASE.nml", names: list[str] | None = None, timeout: float = 10.0,
        language: Language | None = None,
    ) -> None:  # fmt: skip
        if "bearing_load" in case:
            raise gudgeon.CaseError("a bearing by itself has no mechanism to draw: gudgeon-plot bearing")
        self.case, self.source, self.words, self.names, self.timeout = case, source, words, names, timeout
        self.language = language or Language()
        self.newest: dict[str, int] = {}  # of each page, its last request
        self.tables: set[tuple[Any, ...]] = set()  # what whole tables have been made for

    # the case

    def changed(self, values: Mapping[str, Any]) -> gudgeon.Case:
        """The case with these values. Keys that another law does not have are left out. Raises CaseError or KeyError."""
        case = self.case.copy()
        for name, value in values.items():
            key = gudgeon.keys[name] if name in gudgeon.keys else None
            if key and key.kind == "text" and key.name != "oil":
                raise gudgeon.CaseError(f"{name}: texts and tables are changed in the case file")
            case[name] = value
        for name in values:
            for other in gudgeon.groups()[gudgeon.keys[name].group].keys:
                full = f"{other.group}.{other.name}"
                if other.choice == gudgeon.keys[name].name and other.laws and case[name] not in other.laws and case.is_given(other) and full not in values:
                    case[full] = None
        return case

    def control(self, case: gudgeon.Case, name: str) -> dict[str, Any] | None:
        """What the page needs for a key: its kind, words, or range and unit of its slider, value, meaning. None for tables, texts and lists."""
        key, value = gudgeon.keys[name], case[name]
        if key.name != "oil" and (key.kind == "text" or key.count > 1):
            return None
        about = {"name": name, "value": value, "start": self.case[name], "help": key.described(self.language.say), "kind": key.kind}
        if key.kind == "switch":
            return about | {"words": ["false", "true"]}
        if key.kind == "word" or key.name == "oil":
            words = key.words or OILS
            return about | {"words": list(words) if value in words else [value, *words]}
        low, high = slider_range(key, value)
        unit, factor, offset = shown_unit(key.unit, value or high)
        return about | {"low": low, "high": high, "log": low > 0 and high / low > 20, "unit": unit, "factor": factor, "offset": offset}

    def controls(self, values: Mapping[str, Any] = {}, more: Iterable[str] = ()) -> list[dict[str, Any]]:
        """The controls of the case with these values: of what it gives, of the keys of a law that was chosen, and of more keys."""
        case = self.changed(values)
        names = list(self.names) if self.names else [name for name, key in gudgeon.keys.items() if case.is_given(key) and not HIDDEN.match(name)]
        for chosen in values:
            keys = gudgeon.groups()[gudgeon.keys[chosen].group].keys
            names += [f"{key.group}.{key.name}" for key in keys if key.choice == gudgeon.keys[chosen].name and case[chosen] in key.laws]
        names = list(dict.fromkeys([*names, *values, *more]))
        if not self.names:
            names.sort(key=lambda name: next((i for i, part in enumerate(FIRST) if part.search(name)), len(FIRST)))
        return [made for name in names if (made := self.control(case, name))]

    def coarse(self, case: gudgeon.Case) -> gudgeon.Case | None:
        """The case with small tables of its films; None if it has no tables whose size is the program's own, or has them whole."""
        if self.table_of(case) in self.tables:
            return None
        found: dict[str, int] = {}
        for name in (name for name in gudgeon.groups() if f"{name}.table_points" in gudgeon.keys and name in case):
            law = case[f"{name}.law"] in gudgeon.keys[f"{name}.table_points"].laws
            if law and case[f"{name}.variant"] == "table" and not case[f"{name}.table_points"]:
                found |= {f"{name}.table_points": 33, f"{name}.film_points": 32}
        return case.set(found) if found else None

    def table_of(self, case: gudgeon.Case) -> tuple[Any, ...]:
        """The values of a case on which its tables depend."""
        return tuple((name, case[name]) for name, key in gudgeon.keys.items() if TABLE.search(name) and case.is_given(key))

    # runs

    def run(self, page: str, request: int, values: Mapping[str, Any], tier: str) -> bytes:
        """A run in the form that the page draws. `tier`: live, with small tables of films and a limit of time; full; certify. Raises
        Superseded as soon as the page has asked for something newer."""
        began = time.perf_counter()

        def tell(_: float) -> None:
            if self.newest.get(page, 0) > request:
                raise Superseded

        tell(0)
        case = self.changed(values)
        small = self.coarse(case) if tier == "live" else None
        failed = ""
        try:
            run = (small or case).run(progress=tell, timeout=self.timeout if tier == "live" else None, certify=tier == "certify")
        except gudgeon.RunError as error:
            run, failed = error.run, str(error)
        except TimeoutError as error:
            run, failed = error.run, f"{error}: gudgeon-plot explore --timeout sets this limit"  # type: ignore[attr-defined]
        if small is None:
            self.tables.add(self.table_of(case))
        tell(1)
        ran = time.perf_counter()
        if len(run) < 3:
            raise gudgeon.CaseError(failed or "the run has no rows")
        head, data = self.scene(run)
        head |= {"failed": failed, "draft": small is not None, "values": {name: case[name] for name in values if not isinstance(case[name], bool)}}
        head |= {"run_ms": 1e3 * (ran - began), "prepare_ms": 1e3 * (time.perf_counter() - ran)}
        return packed(head, data)

    def scene(self, run: gudgeon.Run) -> tuple[dict[str, Any], dict[str, bytes]]:
        """What the page draws and says of a run."""
        from gudgeon.report.page import warnings
        from gudgeon.report.scene import scene_of
        from gudgeon.results import drawable

        whole, say = drawable(run), self.language.say
        scene, data = scene_of(of_cycle(whole), None, None, self.language, MOST_ROWS, self.is_shown)
        notes = [*warnings(whole, self.language), *sorted(run.notes, key=lambda note: note.startswith("&"))]   # on results before those on keys
        if run.certificate is not None:
            notes.insert(0, say(f"Certified: {run.certificate.digits:.3g} digits until {1e3 * run.certificate.until:.4g} ms"))
        elif scene["contacts"]:
            notes.append(say("Contacts follow each other unpredictably: compare answers over many cycles, not single curves."))
        return {"scene": scene, "answers": answers_of(whole, say), "notes": notes}, data

    @staticmethod
    def is_shown(plot: dict[str, Any]) -> bool:
        """Whether the page has this plot of the report: one over time, or the p-V diagram."""
        return bool(CURVES.fullmatch(plot["curves"][0]["y"])) and (plot["timed"] or "volume" in plot["curves"][0]["x"])

    # what leaves the page

    def case_text(self, values: Mapping[str, Any]) -> bytes:
        """The changed case as a case file."""
        head = f"! gudgeon {gudgeon.version()}, {time.strftime('%Y-%m-%d')}: {self.source}, changed in gudgeon-plot explore\n"
        return (head + self.changed(values).to_nml()).encode()

    def csv(self, values: Mapping[str, Any]) -> bytes:
        """The trace of the changed case, as the command line writes it."""
        with tempfile.TemporaryDirectory() as folder:
            return Path(f"{self.changed(values).run().save(folder)}.csv").read_bytes()

    def report(self, values: Mapping[str, Any]) -> bytes:
        """The page of the changed case's run, which needs no server."""
        from gudgeon.report.page import page
        from gudgeon.results import drawable

        return page(drawable(self.changed(values).run()), language=self.language).encode()

    def html(self, token: str) -> str:
        """The page."""
        from gudgeon.report.page import PAGE, filled, spoken, text_of

        settings = spoken(self.language, "drawing", "explore") | {"token": token, "source": self.source, "words_of_case": self.words}
        settings |= {"controls": self.controls(), "name": self.case.name}
        return filled(text_of("explore.html", self.language), {
            "language": self.language.name,
            "title": self.case.name.replace("&", "&amp;").replace("<", "&lt;"),
            "style": (PAGE / "page.css").read_text(encoding="utf-8") + (PAGE / "explore.css").read_text(encoding="utf-8"),
            "settings": json.dumps(settings, ensure_ascii=False).replace("</", "<\\/"),
            "script": "".join((PAGE / f"{name}.js").read_text(encoding="utf-8") for name in ("drawing", "explore")),
        })  # fmt: skip


def packed(head: dict[str, Any], data: Mapping[str, bytes]) -> bytes:
    """The length of the head, the head, and data whose sizes it has; columns begin at a multiple of four bytes."""
    text = json.dumps(head | {"sizes": {name: len(content) for name, content in data.items()}}, ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<I", len(text)) + text + b"".join(data.values())


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server: "Server"

    def is_allowed(self, token: str) -> bool:
        """Whether a page of this server asks, or someone who has its address."""
        host = re.sub(r":\d+$", "", self.headers.get("Host", ""))
        origin = re.sub(r"^https?://|:\d+$", "", self.headers.get("Origin", "http://localhost"))
        return host in LOCAL and origin in LOCAL and hmac.compare_digest(token.encode(), self.server.token.encode())

    def answer(self, data: bytes | str, kind: str = "application/octet-stream", status: int = 200, encoding: str = "identity") -> None:
        content = data.encode() if isinstance(data, str) else data
        self.send_response(status)
        for name, value in (HEADERS | {"Content-Type": kind, "Content-Encoding": encoding, "Content-Length": str(len(content))}).items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(content)

    def do_GET(self) -> None:
        path, _, token = self.path.partition("?token=")
        if not self.is_allowed(token):
            self.answer("open the address that gudgeon-plot explore has printed\n", "text/plain", 403)
        elif path == "/":
            text, packs = self.server.explorer.html(self.server.token).encode(), "gzip" in self.headers.get("Accept-Encoding", "")
            self.answer(gzip.compress(text) if packs else text, "text/html; charset=utf-8", encoding="gzip" if packs else "identity")
        elif path == "/plotly.js":
            from gudgeon.report.page import LIBRARY

            self.answer(LIBRARY.read_bytes(), "text/javascript; charset=utf-8", encoding="gzip")
        else:
            self.answer("", status=404)

    def do_POST(self) -> None:
        size = self.headers.get("Content-Length", "")
        if not self.is_allowed(self.headers.get("X-Token", "")) or not size.isdigit() or int(size) > LARGEST_REQUEST:
            self.close_connection = True  # what the request still has is not read
            self.answer("", status=413 if size.isdigit() and int(size) > LARGEST_REQUEST else 403)
            return
        try:
            asked = json.loads(self.rfile.read(int(size)))
            found = self.answer_to(self.path, asked)
            self.answer(found or b"", status=404 if found is None else 200)
        except Superseded:
            self.answer(packed({"superseded": True}, {}))
        except (gudgeon.CaseError, gudgeon.RunError, KeyError, TypeError, ValueError, AttributeError) as error:
            said = str(error.args[0]) if error.args else type(error).__name__
            self.answer(packed({"error": said, "key": getattr(error, "key", None)}, {}))

    def answer_to(self, path: str, asked: dict[str, Any]) -> bytes | None:
        """What is answered to a question of the page; None for a path that is not there."""
        explorer = self.server.explorer
        page, request, values = str(asked.get("page", "")), int(asked.get("request", 0)), dict(asked.get("values", {}))
        if path in ("/run", "/stop"):
            explorer.newest[page] = max(request, explorer.newest.get(page, 0))
        if path == "/run":
            return explorer.run(page, request, values, asked["tier"])
        if path == "/stop":
            return packed({}, {})
        if path == "/controls":
            return packed({"controls": explorer.controls(values, asked.get("more", []))}, {})
        if path == "/keys":
            return packed({"keys": [name for name in gudgeon.keys if explorer.control(explorer.case, name)]}, {})
        made = {"/case": explorer.case_text, "/csv": explorer.csv, "/report": explorer.report}.get(path)
        return packed({}, {"file": made(values)}) if made else None

    def log_message(self, *_: object) -> None:
        """Say nothing of requests."""


class Server(http.server.ThreadingHTTPServer):
    """An explorer on a port of this machine, 0: any that is free; `address` opens its page."""

    daemon_threads = True

    def __init__(self, explorer: Explorer, port: int = 0) -> None:
        self.explorer, self.token = explorer, secrets.token_urlsafe(24)
        super().__init__(("127.0.0.1", port), Handler)
        self.address = f"http://127.0.0.1:{self.server_port}/?token={self.token}"

    def server_bind(self) -> None:
        """Without the search for a name of this machine, which may take seconds."""
        socketserver.TCPServer.server_bind(self)
        self.server_name, self.server_port = self.server_address[0], self.server_address[1]  # type: ignore[assignment]

    def handle_error(self, request: object, client_address: object) -> None:
        """A page that has gone is no error."""
        if not isinstance(sys.exc_info()[1], ConnectionError):
            super().handle_error(request, client_address)  # type: ignore[arg-type]


class Session:
    """An explorer that goes on beside the program that has begun it; a notebook shows its page."""

    def __init__(self, case: gudgeon.Case, port: int = 0) -> None:
        self._server = Server(Explorer(case.copy()), port)
        self.address = self._server.address
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()

    def __repr__(self) -> str:
        return f"<Explorer {self.address}>"

    def _repr_html_(self) -> str:
        return f'<iframe width="100%" height="800" style="border:0" allow="clipboard-write" src="{self.address}"></iframe>'
