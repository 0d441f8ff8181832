"""The verdict on one scene: the results of all checks."""
from __future__ import annotations

import dataclasses
import math
import zlib
from pathlib import Path

from .carried import judge_carried, requested_heat
from .charge import judge_charge, requested_charge
from .elastic import requested_columns
from .energy import BLURRED, Balances, balances
from .engine import Engine
from .moving_films import drift, moving_film_drift
from .reruns import Comparison, Reruns
from .rows import RowChecks
from .trace import Run, merged, run_case
from .wear import judge_wear

MOST_STEPS = 60_000       # largest number of steps for which rows are written at every step, besides the grid
CLOSER = 5     # factor for the number of rows if a fault is found
GRID = 4_000              # number of rows of the grid
ENERGY = 100.0            # allowed error of the energy in relative tolerances, for each revolution begun
CEILING = 1e-3            # largest relative error of the energy at any tolerance
DRIFT = 2e-2              # the same of speeds and positions against the integrals of their rates: 20 tolerances at the loosest
CARRIED = 5e-2            # the same of the place of a bearing under its load, over its clearance
FLOOR = 1e-10             # smallest allowed error of the energy: rounding


@dataclasses.dataclass
class Verdict:
    """`faults` is empty if nothing is wrong; `notes` state what could not be judged."""

    faults: list[str] = dataclasses.field(default_factory=list)
    notes: list[str] = dataclasses.field(default_factory=list)
    checks: int = 0                        # kinds of checks made on the rows
    energy: Balances | None = None
    states: Comparison | None = None


def requested(run: Run) -> dict[str, str]:
    """The setting that adds to the trace the columns on request that the judge needs."""
    names = requested_columns(run) + requested_heat(run) + requested_charge(run) + (Engine(run).requested() if Engine.is_in(run) else [])
    return {"output.columns": "'" + ", ".join(("standard", *names)) + "'"} if names else {}


def has_no_mechanism(run: Run) -> bool:
    """Whether the case is a bearing by itself."""
    return "bearing_load.period_deg" in run.case


def judge_rows(run: Run, verdict: Verdict) -> RowChecks:
    """Check mechanics and laws in every row."""
    checks = RowChecks(run)
    found = checks.check()
    verdict.checks += len(found)
    verdict.faults += [miss.text for miss in found.values() if not miss.share <= 1]
    return checks


def allowed_error(run: Run) -> float:
    """Allowed error of the energy and of integrals."""
    tolerance = min(run.number("integrator.relative_tolerance"), 1e-3)
    angle = run.columns["crank_angle"]
    return ENERGY * tolerance * max(1.0, abs(angle[-1] - angle[0]) / (2 * math.pi))


def judge_energy(checks: RowChecks, verdict: Verdict) -> None:
    """Check the energy balance, and speeds and positions against the integrals of their rates."""
    run = checks.run
    allowed, drifts = (max(FLOOR, min(ceiling, allowed_error(run))) for ceiling in (CEILING, DRIFT))
    found = verdict.energy = balances(checks)
    if found.bound > BLURRED:
        verdict.notes.append(f"integrals not judged: the quadrature is only known to {found.bound:.1g}")
        return
    for joint, prefix in ((checks, ""), (checks.crank_pin, "crank_pin_")):
        if joint and joint.elastic and joint.film_law and not joint.film_law.is_solved:
            drift, _, name = moving_film_drift(joint)
            verdict.checks += 1
            if not drift <= allowed:
                verdict.faults.append(f"film law: {prefix}{name} is not the integral of the rate by the film's force: {drift:.3g} of the clearance "
                                      f"off, {allowed:.1g} allowed")
    if found.plain > allowed and not found.residual > allowed:
        verdict.notes.append(f"energy not judged: {found.plain:.1g} of it is missing, but the quadrature is only known to {found.bound:.1g}")
    if not found.residual <= allowed:
        verdict.faults.append(f"energy not kept: {found.residual:.3g} of it against {allowed:.1g} allowed, at t = {found.time:.9g} s; "
                              f"the column energy_residual says {found.claimed:.3g}")
    if not found.differs <= allowed:
        verdict.faults.append(f"the column energy_residual is off by {found.differs:.3g} of the energy, {allowed:.1g} allowed")
    if not found.drift <= drifts:
        verdict.faults.append(f"{found.worst} is not the integral of its rate: {found.drift:.3g} of its size off, {drifts:.1g} allowed")


def judge_stations(checks: RowChecks, allowed: float) -> tuple[int, list[str], list[str]]:
    """Number of checks, faults and notes on the stations of a crankshaft: their angular momentum against the integral of their torques."""
    engine, columns, times = checks.bodies.engine, checks.run.columns, checks.run.times
    gets = [{name: column[i] for name, column in columns.items()} for i in range(len(times))]
    made, faults, span = 0, [], times[-1] - times[0]
    for j in range(len(engine.inertia)):
        if j == engine.full or j == engine.driven and checks.run.text("drive.kind") != "free":
            continue   # the crank's law, and a speed that is held
        momentum = [engine.moving(get, j) * engine.speed(get, j) for get in gets]
        rates = {i: (math.fsum(engine.torques(get, j, checks.bodies.damping)), 0.0) for i, get in enumerate(gets)}
        rounding = max(engine.rounding(get, j) for get in gets) * span
        at_scale = max(engine.moving(get, j) for get in gets) * (abs(checks.run.number("initial.crank_speed")) or 1 / span)   # of the absolute tolerance
        size = max(*map(abs, momentum), at_scale, rounding / allowed, 1e-300)
        made += 1
        far, _, _ = drift(times, rates, {"momentum": momentum}, size)
        if not far <= allowed:
            faults.append(f"station {j + 1}: its angular momentum is not the integral of its torques: {far:.3g} of it off, {allowed:.1g} allowed")
    return made, faults, ["work not judged: that of other cylinders and of the shaft"]


def judge_files(run: Run, resolved: bool = True) -> Verdict:
    """Judge the files of one run only. `resolved`: the rows are close enough for integrals over them."""
    verdict = Verdict()
    if run.status or len(run.times) < 2:
        verdict.faults.append(f"no rows to judge: {run.summary.get('status', run.message)[:120]}")
        return verdict
    checks = None if has_no_mechanism(run) else judge_rows(run, verdict)
    judged = [judge_charge(checks, max(FLOOR, min(DRIFT, allowed_error(run))), resolved)] if checks else []
    if resolved:
        judged.append(judge_carried(run, max(FLOOR, min(CARRIED, allowed_error(run)))))
        if checks and checks.bodies.engine:
            judged.append(judge_stations(checks, max(FLOOR, min(DRIFT, allowed_error(run)))))
        elif checks:
            judge_energy(checks, verdict)
        if checks:
            judged.append(judge_wear(checks))
    else:
        verdict.notes.append("integrals not judged: too many steps for a row at each, and contacts between the rows of the grid")
    for made, faults, notes in judged:
        verdict.checks += made
        verdict.faults += faults
        verdict.notes += notes
    return verdict


def judge_scene(program: Path, case: Path, settings: dict[str, str], limit: float = 300.0) -> Verdict:
    """Run a scene with rows at every step and on a fine grid, judge them, and compare with runs by the other method."""
    plain = {key: value for key, value in settings.items() if not key.startswith("output.")}
    plain |= {"output.ideal_twin": ".false.", "output.digits": "17"}
    rows = {key: value for key, value in settings.items() if key in ("output.interval", "output.samples_per_revolution")}
    first = run_case(program, case, {**plain, **rows}, limit)
    if first.status or not first.times:
        return Verdict(notes=[f"not judged: {first.summary.get('status', first.message)[:120]}"])
    more = requested(first)
    plain |= more
    span = float(first.summary["simulated_time"])
    resolved = float(first.summary["steps_accepted"]) <= MOST_STEPS

    def judge_rows_on(grid: int) -> Verdict:
        fine = run_case(program, case, {**plain, "output.interval": repr(span / grid)}, limit)
        if resolved and not fine.status:
            every = run_case(program, case, {**plain, "output.interval": repr(span), "output.every_step": ".true."}, limit)
            fine = every if every.status else merged(every, fine)
        return judge_files(fine, resolved or not first.events)

    verdict = judge_rows_on(GRID)
    if verdict.faults:   # faults of integrals over rows that are too far apart vanish with more rows
        verdict = judge_rows_on(CLOSER * GRID)
    if has_no_mechanism(first):
        verdict.notes.append("states not compared: there is no mechanism")
        return verdict
    seed = zlib.crc32(repr(sorted(settings.items())).encode())
    found = verdict.states = Reruns(program, case, settings | more, first, limit, seed).compare()
    if found.unjudged:
        verdict.notes.append(f"states not compared: {found.unjudged}")
    if not found.share <= 1:
        verdict.faults.append(f"the state is {found.tolerances:.3g} grown tolerances from that of the other method at t = {found.time:.9g} s "
                              f"(horizon {found.horizon:.3g} s): {found.share:.3g} times the allowed distance")
    if found.no_statistics:
        verdict.notes.append(f"statistics not compared: {found.no_statistics}")
    for name, share in found.statistics.items():
        if not share <= 1:
            verdict.faults.append(f"{name} beyond the horizon: {share:.3g} times the difference that chance allows")
    return verdict


def summary_of(verdict: Verdict) -> list[str]:
    """Lines that state what was measured, what could not be judged, and what is wrong."""
    lines = [f"{verdict.checks} kinds of checks in every row"] if verdict.checks else ["nothing was judged"]
    if verdict.energy:
        one = verdict.energy
        lines.append(f"energy balances to {one.plain:.1e} of it by a quadrature known to {one.bound:.1e}; the column says {one.claimed:.1e}")
    if verdict.states and not verdict.states.unjudged:
        two = verdict.states
        lines.append(f"state within {two.tolerances:.2g} grown tolerances of that by the other method in {two.rows} rows up to "
                     f"{two.horizon:.3g} s")
        lines += [f"{name} beyond the horizon: {share:.2g} of the difference that chance allows" for name, share in two.statistics.items()]
    return lines + verdict.notes + [f"FAILED: {fault}" for fault in verdict.faults]
