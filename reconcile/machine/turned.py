"""Test and baseline must have turned alike: labels say what was meant, pulses and lines say what was.

A change of speed moves every line past the machine's resonances, which no drift between two recordings explains: a
sound machine at another speed than its baseline shows a change that effects are fitted to.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import maximum_filter1d

from reconcile.atlas.plan import Point
from reconcile.gate.findings import Finding, Gate
from reconcile.gate.spoiled import doubts
from reconcile.machine.stages import gate_stage
from reconcile.machine.strange import OWN
from reconcile.observe.observation import SAME_SPEED, PointData, alike, grouped, tooth_orders
from reconcile.observe.steady import Steady
from reconcile.speed import SpeedEstimate, estimate_speed, line_logs
from reconcile.speed.estimate import comb_score
from reconcile.speed.excess import line_excess
from reconcile.verdict import NextExperiment, Report, SensorFault, Where
from signals.recording import Recording
from signals.series import FloatArray
from sim.core.errors import SpecError
from sim.core.response import Channel
from sim.core.spec import MachineSpec

WIDELY, STEPS = 0.3, 6001
"""Share of the stated speed within which the teeth are looked for where no line near it was found, and how finely."""
HARMONICS = 6
CLEAR = 3.0
"""Log power over what noise reaches, from which a line is told."""
FITS = 0.3
"""Least share of the distance that a named effect takes off data it was not fitted to, from which its own lines, all of
which hang on the speed, confirm it."""
ENOUGH = 0.6
"""Of the baseline's score at its speed, from which the same teeth have been found in the test."""
MISLABELLED = 0.1
"""Share of a stated speed by which a label may be off for its lines to be asked."""
COMPARED = "it is compared with that"
"""How the remark on a test ends that states another speed than the baseline it is compared with."""


def as_baselines_turned(machine: MachineSpec, gate: Gate, seed: int) -> Gate:
    """With the baselines' speed stated of tests whose own statement leaves them none, where lines or pulses of both
    show that they turned alike: a label that is some per cent off says another operating point."""
    known = grouped(machine, gate.baselines)
    tests, found = list(gate.tests), []
    orders = tooth_orders(machine)[:2]
    before: dict[Point, list[float]] = {}
    for k, test in enumerate(tests):
        ((point, _),) = grouped(machine, [test])
        if test.operating is None or not known or any(alike(p, point) for p, _ in known):
            continue
        near = [(p, m) for p, m in known if abs(p.speed_hz / point.speed_hz - 1.0) <= MISLABELLED]
        near = [(p, m) for p, m in near if alike(replace(point, speed_hz=p.speed_hz), p)]
        now = _shown_hz([test], orders, seed) if near else []
        before |= {p: _shown_hz(members, orders, seed) for p, members in near if now and p not in before}
        fits = [p for p, _ in near if now and before[p] and _turned_so(now[0], before[p])]
        if len(fits) == 1:
            stated_hz = fits[0].speed_hz
            tests[k] = replace(test, operating=replace(test.operating, speed_hz=stated_hz))
            detail = (
                f"{point.speed_hz:g} Hz are stated, its lines show {now[0]:.4g} Hz, as those of the baseline stated as "
                f"{stated_hz:g} Hz do: {COMPARED}"
            )
            found.append(
                Finding(kind="speed_mismatch", channel="", recording=f"test {k + 1}", detail=detail, severity=0.0)
            )
    return replace(gate, tests=tuple(tests), findings=(*gate.findings, *found)) if found else gate


def _shown_hz(recordings: Sequence[Recording], orders: Sequence[float], seed: int) -> list[float]:
    """Speeds that lines or pulses of all of them show; empty where those of one show none, or it is too short."""
    try:
        found = _confirmed([estimate_speed(one, orders=orders, seed=seed) for one in recordings])
    except SpecError:
        return []
    return [one.speed_hz for one in found] if len(found) == len(recordings) else []


def _turned_so(speed_hz: float, before_hz: Sequence[float]) -> bool:
    return all(abs(speed_hz / one - 1.0) <= SAME_SPEED for one in before_hz)


def turned_alike(
    machine: MachineSpec, data: Sequence[PointData], channels: Sequence[Channel]
) -> tuple[tuple[PointData, ...], tuple[str, ...]]:
    """The points whose tests turned as their baselines did and as stated, and what is told of the others, and of those
    whose speed no line confirms."""
    kept, told = [], []
    for point in data:
        apart, remark = _told_of(machine, point, channels)
        told += [remark] if remark else []
        kept += [] if apart else [point]
    return tuple(kept), tuple(told)


def _told_of(machine: MachineSpec, point: PointData, channels: Sequence[Channel]) -> tuple[bool, str]:
    """Whether the point must be left out, and what is said of it."""
    stated = f"{point.point.speed_hz:g} Hz"
    now, before = _confirmed(point.turned), _confirmed(point.turned_before)
    for one in now:
        for other in before:
            if abs(one.speed_hz / other.speed_hz - 1.0) > SAME_SPEED:
                turned = f"the test turned at {one.speed_hz:.4g} Hz, the baseline at {other.speed_hz:.4g} Hz"
                return True, f"stated are {stated}, but {turned}"
    if len(now) == len(point.turned) and len(before) == len(point.turned_before):
        return False, _off_label(point, [*now, *before])
    if not _has_teeth(machine):  # a sound rotor may show no line at all
        unsure = f"no line of the test confirms the stated {stated}, on which all its orders hang"
        return False, "" if now else f"{unsure}{_clearest(point, channels)}"
    if before and not now:
        return True, f"no line of the test confirms the stated {stated}, {_elsewhere(machine, point, channels)}"
    return False, f"no line confirms the stated {stated} of every recording there"


def _off_label(point: PointData, found: Sequence[SpeedEstimate]) -> str:
    """What is said where pulses or lines show another speed than is stated, alike in all recordings."""
    speed_hz = float(np.mean([one.speed_hz for one in found]))
    stated_hz = point.point.speed_hz
    if abs(speed_hz / stated_hz - 1.0) <= SAME_SPEED:
        return ""
    alike = " in test and baseline alike" if point.turned_before else ""
    shown = "pulses show" if all(one.method == "tacho" for one in found) else "lines show"
    return f"stated are {stated_hz:g} Hz, but {shown} {speed_hz:.4g} Hz{alike}: that was taken"


def _confirmed(speeds: Sequence[SpeedEstimate]) -> list[SpeedEstimate]:
    return [s for s in speeds if s.method != "stated"]


def _has_teeth(machine: MachineSpec) -> bool:
    return bool(_teeth(machine))


def _teeth(machine: MachineSpec) -> list[float]:
    shaft = machine.operating.shaft if machine.operating is not None else ""
    return sorted({float(g.teeth) for g in machine.gears if g.shaft == shaft})


def _elsewhere(machine: MachineSpec, point: PointData, channels: Sequence[Channel]) -> str:
    """Where the baseline's teeth are found in the test, if they are."""
    test, baseline = point.spectra
    if baseline is None:
        return "and there is no baseline"
    before = _score(machine, baseline, channels, np.array([baseline.speed_hz]))[0]
    speeds = np.linspace(1.0 - WIDELY, 1.0 + WIDELY, STEPS) * point.point.speed_hz
    now = _score(machine, test, channels, speeds)
    best = int(np.argmax(now))
    if now[best] < ENOUGH * before:
        return "at which the baseline's teeth are found"
    return f"at which the baseline's teeth are found: in the test they are at about {speeds[best]:.3g} Hz"


def _clearest(point: PointData, channels: Sequence[Channel]) -> str:
    """Where the test's clearest line stands, if any does: the one that is farthest above the noise around it."""
    recording = point.spectra[0].recording(channels)
    tops = []
    for (log, width), name in zip(line_logs(recording), recording.names, strict=True):
        excess = np.where(log >= CLEAR, line_excess(recording.series(name))[0], 0.0)
        top = int(np.argmax(excess))
        tops.append((float(excess[top]), top * width))
    most, hz = max(tops)
    share = hz / point.point.speed_hz
    return f"; its clearest line is at {hz:.4g} Hz, {share:.3g} times that" if most > 0.0 else ""


def _score(machine: MachineSpec, one: Steady, channels: Sequence[Channel], speeds_hz: FloatArray) -> FloatArray:
    """Mean log power over the floor at the teeth's lines of each speed, (speeds,)."""
    combs = line_logs(one.recording(channels))
    orders = [float(n * z) for z in _teeth(machine) for n in range(1, HARMONICS + 1)]
    scores = [comb_score(maximum_filter1d(log, 3), width, speeds_hz, orders) for log, width in combs]
    return np.asarray(np.mean(scores, axis=0))


def told_apart(told: Sequence[str], data: Sequence[PointData], gate: Gate, provenance: Mapping[str, object]) -> Report:
    """The report where no test turned as its baseline did."""
    fault = SensorFault(kind="speed_mismatch", channel="", detail="; ".join(told))
    return Report(
        verdict="measurement_fault",
        sentence=f"The mismatch is in the measurement: the recordings are not of one speed ({fault.detail}). What "
        "differs is not compared: every line stands elsewhere against the machine's resonances.",
        level="machine",
        where=Where(limits=doubts(gate)),
        fault=fault,
        undecidable=("whether anything is missing: there is no baseline of the speed at which the machine turned",),
        next_experiment=NextExperiment(
            sentence="Correct the speed that the description states, or record a baseline at the speed of the test."
        ),
        stages=(gate_stage(gate), {"name": "observe", "speeds": [points_text(d) for d in data]}),
        provenance=provenance,
    )


def points_text(point: PointData) -> str:
    """The speeds found in the recordings of a point beside the stated one."""
    found = ", ".join(_found_text(s) for s in (*point.turned, *point.turned_before))
    return f"{point.point.speed_hz:g} Hz stated, found {found}"


def _found_text(found: SpeedEstimate) -> str:
    return "none that confirms it" if found.method == "stated" else f"{found.speed_hz:.3f} Hz ({found.method})"


def with_unconfirmed(report: Report, machine: MachineSpec, data: Sequence[PointData]) -> Report:
    """The report of a machine without teeth, of which no line confirms the speed of some point: that is said with what
    differs, and where no known effect explains it, it may be all there is."""
    unsure = [d.point.speed_hz for d in data if not _confirmed(d.turned)]
    if _has_teeth(machine) or len(unsure) < len(data) or report.verdict in ("nothing_missing", "measurement_fault"):
        return report
    by_itself = any(stage.get("name") in OWN for stage in report.stages)
    if by_itself and report.verdict == "unknown_physics":  # what keeps its own time hangs on no order
        return report
    if report.verdict == "explained" and report.held_out is not None and (report.held_out.gain_low or 0.0) >= FITS:
        return report
    own = machine.operating.speed_hz if machine.operating is not None else 0.0
    stated = " and ".join(f"{hz:g}" for hz in unsure)
    off = any(abs(hz / own - 1.0) > SAME_SPEED for hz in unsure) if own > 0.0 else False
    file = f" (the machine file's speed is {own:g} Hz)" if off else ""
    sentence = f"{report.sentence} No line confirms the stated speed of {stated} Hz{file}, on which all orders hang."
    if report.verdict != "unknown_physics":
        return replace(report, sentence=sentence)
    return replace(
        report,
        verdict="not_decidable",
        sentence=sentence,
        where=replace(report.where, sites=()),
        force=None,
        machine=None,
        undecidable=("whether physics is missing or the stated speed is wrong", *report.undecidable),
        next_experiment=NextExperiment(
            sentence=f"Check the stated speed of {stated} Hz{file}, or record with a tacho; then the numbers of the "
            "bearings in the machine file."
        ),
    )


def with_limits(report: Report, told: Sequence[str]) -> Report:
    """The report with what was left out, or is unconfirmed, among its limits."""
    if not told:
        return report
    return replace(report, where=replace(report.where, limits=(*report.where.limits, *told)))
