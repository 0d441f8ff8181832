"""Opens a page whose sliders run a case: mechanism, orbits, curves and answers follow the hand.

    gudgeon-plot explore engine.nml
    gudgeon-plot explore dry --set 'joint.clearance=50 um' --keys joint.clearance contact.restitution

The page is served to this machine alone, at the address that is printed; Ctrl-C ends it. From another machine: ssh -L, as is said then.
A template of `gudgeon --template` stands for a case file.
"""

import argparse
import os
import shlex
import signal
import sys
import webbrowser

import gudgeon
from gudgeon import language
from gudgeon._library import LibraryMissing
from gudgeon.commands import Refused, number
from gudgeon.program import MissingResult
from gudgeon.report.explorer import Explorer, Server


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("case", metavar="CASE", help="case file, or a template: dry, film, engine, ...")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a value of the case, such as 'joint.clearance=50 um'; repeatable")
    parser.add_argument("--keys", nargs="+", metavar="KEY", help="keys on sliders (default: those that the case gives)")
    parser.add_argument("--port", type=number(0, whole=True), default=0, metavar="N", help="(default: any that is free)")
    parser.add_argument("--timeout", type=number(0, itself=False), default=10.0, metavar="SECONDS", help="limit of runs that follow a slider (default: 10)")
    parser.add_argument("--no-browser", action="store_true", help="print the address only")


def read(options: argparse.Namespace) -> gudgeon.Case:
    """The case of the command line. Raises Refused or MissingResult."""
    is_file = options.case.endswith(".nml")
    try:
        case = gudgeon.read(options.case) if is_file else gudgeon.template(options.case)
        for word in options.set:
            name, _, value = word.partition("=")
            case[name.strip()] = value.strip()
        case.check()
        for name in options.keys or ():
            case[name]
    except LibraryMissing as problem:
        raise MissingResult(problem) from None
    except (gudgeon.CaseError, KeyError, ValueError) as problem:
        raise Refused(problem.args[0]) from None
    return case


def run(options: argparse.Namespace) -> int:
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # a page that has gone
    case, file = read(options), options.case if options.case.endswith(".nml") else ""
    sets = {name.strip(): value.strip() for name, _, value in (word.partition("=") for word in options.set)}
    source = (f"gudgeon.read({file!r})" if file else f"gudgeon.template({options.case!r})") + (f".set({sets!r})" if sets else "")
    words = shlex.join([*(word for setting in options.set for word in ("--set", setting)), file or "CASE.nml"])
    try:
        server = Server(Explorer(case, source, words, options.keys, options.timeout, language.current), options.port)
    except OSError as problem:
        raise MissingResult(f"port {options.port}: {problem.strerror}") from None
    except gudgeon.CaseError as problem:
        raise Refused(f"{options.case}: {problem}") from None
    except OverflowError:
        raise Refused(f"port {options.port}: must be at most 65535") from None
    print(server.address, flush=True)
    port = server.server_port
    print(f"{language.current.say('Ctrl-C ends it. From another machine:')} ssh -L {port}:localhost:{port} {os.uname().nodename}", file=sys.stderr, flush=True)
    if not options.no_browser and (sys.platform == "darwin" or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        webbrowser.open(server.address)
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        print(file=sys.stderr)
    return 0
