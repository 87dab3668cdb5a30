"""The gate itself: all checks in the order in which one spoils the next, and the cleaning."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from reconcile.gate.alias import alias_findings
from reconcile.gate.breaks import break_findings
from reconcile.gate.compare import compared, swap_order
from reconcile.gate.copied import copy_findings
from reconcile.gate.far import far_speeds
from reconcile.gate.filtered import below_the_corner, filter_findings
from reconcile.gate.findings import Finding, Gate, worst
from reconcile.gate.harmonic import harmonic_findings
from reconcile.gate.levels import pairs
from reconcile.gate.loops import loop_findings
from reconcile.gate.loose import transferred
from reconcile.gate.mains import hum_findings, without_hum
from reconcile.gate.noiseless import noiseless, told, with_floor
from reconcile.gate.samples import repaired, sample_findings
from reconcile.gate.spikes import spike_findings, without_spikes
from reconcile.gate.timing import length_findings, speed_findings, tacho_findings
from reconcile.gate.tones import tone_findings
from reconcile.speed import SpeedEstimate, estimate_speed
from signals.recording import Recording
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

SHAFT_HARMONICS = 20
MESH_HARMONICS = 10
SIDEBANDS = 5
WORSE = 3.0
"""A defect three times as bad as in the baseline is a new one."""
GRAVE = 0.5
"""A baseline that is spoiled as badly is itself the answer."""


def inspect_measurement(
    baselines: Sequence[Recording],
    tests: Sequence[Recording],
    *,
    orders: Sequence[float] = (),
    mesh_orders: Sequence[float] = (),
    shaft_orders: Sequence[float] = (1.0,),
    lowest_order: float = 1.0,
    times: Sequence[Finding] = (),
    seed: int = 0,
) -> Gate:
    """Findings, cleaned recordings and the fault to answer with if nothing else is missing.

    `orders`: cycles per revolution of the operating shaft at which the machine has lines (bearings, other shafts);
    `mesh_orders`: teeth of the gears on it; `shaft_orders`: turns of all shafts; `lowest_order`: of what turns
    slowest (a cage); `times`: what `time_stamp_findings` said where the files held time stamps.
    """
    if not tests:
        raise SpecError(Problem(field="tests", message="needs at least one recording", given=0, allowed="1 or more"))
    labels = [
        *(f"baseline {i}" for i in range(1, len(baselines) + 1)),
        *(f"test {i}" for i in range(1, len(tests) + 1)),
    ]
    raw = [*baselines, *tests]
    found: list[Finding] = list(times)
    clean: list[Recording] = []
    usable = True
    for recording, label in zip(raw, labels, strict=True):
        found += spike_findings(recording, label)
        alone = without_spikes(recording)
        found += sample_findings(alone, label)
        looped = loop_findings(recording, label)
        found += (*looped, *(() if looped else break_findings(alone, label)))
        fixed, lost = repaired(alone)
        gone = {*lost, *(f.channel for f in looped)}
        usable &= len(gone) < len(recording.names)
        kept = [name for name in fixed.names if name not in gone]
        clean.append(fixed.select(channels=kept) if kept and len(kept) < len(fixed.names) else fixed)
    if not usable:
        cut = len(baselines)
        shown = _only_new(found)
        return Gate(
            findings=shown, baselines=tuple(clean[:cut]), tests=tuple(clean[cut:]), fault=worst(shown), usable=False
        )
    copied = copy_findings(clean[len(baselines) :], clean[: len(baselines)], labels[len(baselines) :])
    found += copied
    clean = _without({f.channel for f in copied if f.fault}, clean)
    return _analysed(clean, labels, len(baselines), found, orders, mesh_orders, shaft_orders, lowest_order, seed)


def _without(channels: Collection[str], recordings: Sequence[Recording]) -> list[Recording]:
    """The recordings without these channels."""
    kept = [[name for name in r.names if name not in channels] for r in recordings]
    return [r.select(channels=names) for r, names in zip(recordings, kept, strict=True)] if channels else [*recordings]


def _analysed(
    clean: list[Recording],
    labels: list[str],
    cut: int,
    found: list[Finding],
    orders: Sequence[float],
    mesh_orders: Sequence[float],
    shaft_orders: Sequence[float],
    lowest_order: float,
    seed: int,
) -> Gate:
    """Checks that need a spectrum."""
    without_noise = noiseless(clean, labels)
    bare = {f.channel for f in without_noise}
    found += without_noise
    speeds = [_speed(r, mesh_orders, seed) for r in clean]
    hertz = [1.0 if s is None else s.speed_hz for s in speeds]
    for recording, label, speed in zip(clean, labels, speeds, strict=True):
        found += tacho_findings(recording, label)
        if speed is not None:
            found += length_findings(recording, label, speed.speed_hz, lowest_order)
            found += speed_findings(speed, label)
    expected, halves = _own_lines(clean, speeds, orders, mesh_orders, shaft_orders, seed)
    for i, recording in enumerate(clean):
        hum = hum_findings(recording, labels[i], expected[i], clean[:cut] if i >= cut else (), halves[i])
        # hum of a baseline is subtracted and explains nothing that a test shows
        found += hum if i >= cut else tuple(replace(f, fault=False) for f in hum)
    hummed = {f.recording for f in found if f.kind == "mains_hum"}
    clean = [
        without_hum(r, e, h) if label in hummed else r
        for r, e, h, label in zip(clean, expected, halves, labels, strict=True)
    ]
    bases, tests = clean[:cut], clean[cut:]
    if all(s is not None for s in speeds):
        hums = {f.channel for f in found if f.kind == "mains_hum" and f.fault}
        before = list(zip(bases, hertz[:cut], strict=True))
        alone, tests = harmonic_findings(tests, labels[cut], hertz[cut:], expected[cut:], before, hums, halves[cut:])
        found += alone
        tones, tests = tone_findings(tests, labels[cut:], hertz[cut:], expected[cut:], bases, orders)
        found += tones
        clean = [*bases, *tests]
        both = list(zip(clean, hertz, strict=True))
        found += told(alias_findings(both[cut:], labels[cut:], mesh_orders, both[:cut], seed=seed), bare)
    matched = pairs(tests, bases, hertz[cut:], hertz[:cut])
    filtered = filter_findings(matched)
    found += filtered
    for one in filtered:
        bases, tests = below_the_corner(bases, one, undone=False), below_the_corner(tests, one, undone=True)
        matched = pairs(tests, bases, hertz[cut:], hertz[:cut])
    differences = told(compared(matched, tests), bare)
    found += differences
    if any(f.kind == "swapped_channels" for f in differences):
        order = swap_order(matched, tests)
        tests = [_unswapped(t, matched[0].names, order) for t in tests]
    tests = [_regained(t, differences) for t in tests]
    shown = _only_new(found)
    floored = with_floor([*bases, *tests], hertz, bare)
    return Gate(findings=shown, baselines=floored[:cut], tests=floored[cut:], fault=worst(shown), usable=True)


def _speed(recording: Recording, mesh_orders: Sequence[float], seed: int) -> SpeedEstimate | None:
    """Speed as far as it can be told; None where neither pulses nor a stated speed are there."""
    try:
        return estimate_speed(recording, orders=tuple(mesh_orders), seed=seed)
    except SpecError:
        return None


def _own_lines(
    recordings: Sequence[Recording],
    speeds: Sequence[SpeedEstimate | None],
    orders: Sequence[float],
    mesh_orders: Sequence[float],
    shaft_orders: Sequence[float],
    seed: int,
) -> tuple[list[FloatArray], list[FloatArray]]:
    """What is no hum of each recording, Hz: the machine's own lines and half multiples of its shafts; those at the
    speed at which its lines stand, too, where that is far from the stated one."""
    others = [r for r in shaft_orders if r != 1.0]
    far = far_speeds(recordings, speeds, ratios=others, seed=seed)
    turned = [
        [0.0 if s is None else s.speed_hz, *(() if f is None else (f.speed_hz,))]
        for s, f in zip(speeds, far, strict=True)
    ]
    expected = [np.concatenate([_expected(hz, orders, mesh_orders) for hz in several]) for several in turned]
    return expected, [np.concatenate([_halves(hz, shaft_orders) for hz in several]) for several in turned]


def _expected(speed_hz: float, orders: Sequence[float], mesh_orders: Sequence[float]) -> FloatArray:
    """The machine's own lines near which no hum is claimed, shape (lines,), Hz."""
    if speed_hz <= 0:
        return np.zeros(0)
    lines = [float(k) for k in range(1, SHAFT_HARMONICS + 1)]
    lines += [k * o for o in orders for k in range(1, MESH_HARMONICS + 1)]
    lines += [
        k * z + n for z in mesh_orders for k in range(1, MESH_HARMONICS + 1) for n in range(-SIDEBANDS, SIDEBANDS + 1)
    ]
    return np.asarray(sorted(set(lines)), dtype=np.float64) * speed_hz


def _halves(speed_hz: float, shaft_orders: Sequence[float]) -> FloatArray:
    """Half multiples of the shafts, shape (lines,), Hz: what something loose makes."""
    odd = np.arange(SHAFT_HARMONICS) + 0.5
    return np.outer(np.asarray(shaft_orders, dtype=np.float64), odd).ravel() * max(speed_hz, 0.0)


def _only_new(found: Sequence[Finding]) -> tuple[Finding, ...]:
    """A small defect that a baseline's channel has as well explains no difference: it stays as a remark, in both."""
    before, after = (_worst_of(found, which) for which in ("baseline", "test"))
    result = []
    for f in found:
        old = before.get((f.kind, f.channel), 0.0)
        new = f.severity if f.recording.startswith("test") else after.get((f.kind, f.channel), 0.0)
        shared = 0 < new <= WORSE * old < WORSE * GRAVE
        result.append(replace(f, fault=f.fault and not shared))
    return tuple(result)


def _worst_of(found: Sequence[Finding], which: str) -> dict[tuple[str, str], float]:
    """Severity of the worst finding of each kind and channel in recordings so called."""
    worst_ones: dict[tuple[str, str], float] = {}
    for f in found:
        if f.recording.startswith(which):
            worst_ones[f.kind, f.channel] = max(f.severity, worst_ones.get((f.kind, f.channel), 0.0))
    return worst_ones


def _unswapped(recording: Recording, names: Sequence[str], order: Sequence[int]) -> Recording:
    """Rows put back to the channels whose signals they carry."""
    samples = recording.samples.copy()
    for c, target in enumerate(order):
        samples[recording.names.index(names[target])] = recording.samples[recording.names.index(names[c])]
    return replace(recording, samples=samples)


def _regained(recording: Recording, findings: Sequence[Finding]) -> Recording:
    """Gains and the transfer of loose sensors undone as measured."""
    faults = [f for f in findings if f.fault]
    samples = recording.samples.copy()
    for f in faults:
        if f.gain_db is not None and f.channel in recording.names:
            samples[recording.names.index(f.channel)] *= 10 ** (-f.gain_db / 20)
    return transferred(replace(recording, samples=samples), faults, -1)
