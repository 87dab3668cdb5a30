"""The entry of the level `driven`."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace

from reconcile.driven.analysis import analyse
from reconcile.driven.another import beside_baseline
from reconcile.driven.answer import answer
from reconcile.driven.channels import Driven, driven_of
from reconcile.driven.direction import directed
from reconcile.driven.either import either
from reconcile.driven.faulty import UNIT_NOT_KNOWN, Held, beside, fault_report, held_against
from reconcile.driven.forced import Analysis
from reconcile.driven.judge import ROUGH
from reconcile.driven.machine import Site, driven_site
from reconcile.driven.measured import LEAST_KEPT, of_file
from reconcile.driven.model import share_kept
from reconcile.driven.noise import noise_of
from reconcile.driven.pair import Paired, paired, with_pairs
from reconcile.driven.prescribed.answer import reconcile_prescribed
from reconcile.driven.prescribed.faults import held_motions
from reconcile.driven.rest import beside_tones, settled
from reconcile.driven.split import parts_of
from reconcile.driven.spoiled import Mended, mended, proved, sensor_fault, with_bad
from reconcile.gate.findings import Finding
from reconcile.origin import origin
from reconcile.told import about, place
from reconcile.verdict import NOT_JUDGED, Report
from signals.recording import Recording
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec

LEAST_SAMPLES = 3000
"""Of one recording: three parts, each with a fit and blocks of its own."""


def _checked(spec: MachineSpec, recordings: Sequence[Recording]) -> list[Driven]:
    if not recordings:
        raise SpecError(
            Problem(field="recordings", message="there is nothing to compare", given=0, allowed="1 or more")
        )
    with about(recordings[0].label):
        first = directed(recordings[0], spec)
    check_rates(recordings)
    rest = [_further(r, spec, first.prescribed) for r in recordings[1:]]
    found = [first, *rest]
    for i, (one, data) in enumerate(zip(recordings, found, strict=True)):
        least = LEAST_SAMPLES if len(found) == 1 else LEAST_SAMPLES // 3
        if data.answer.size < least:
            message = "is too short for fitting and holding out"
            raise SpecError(
                Problem(
                    field=place(one, "recording", i, "samples"),
                    message=message,
                    given=data.answer.size,
                    allowed=f"{least} samples",
                )
            )
    return found


def check_rates(tests: Sequence[Recording]) -> None:
    """SpecError where the tests are not all sampled at one rate, by their descriptions; baselines may be at any."""
    first, problems = tests[0], []
    for i, one in enumerate(tests):
        if abs(one.sampling_rate_hz / first.sampling_rate_hz - 1.0) > 1e-6:
            usual = place(first, "recording", 0, "sampling_rate_hz")
            message = f"differs from {usual}, which has {first.sampling_rate_hz:g} Hz: either may be wrong"
            where = place(one, "recording", i, "sampling_rate_hz")
            problems.append(
                Problem(field=where, message=message, given=one.sampling_rate_hz, allowed="the same in both", unit="")
            )
    if problems:
        raise SpecError(problems)


def _further(recording: Recording, spec: MachineSpec, motion_drives: bool) -> Driven:
    with about(recording.label):
        return driven_of(recording, spec, motion_drives=motion_drives)


def _read(
    spec: MachineSpec, tests: Sequence[Recording], baselines: Sequence[Recording]
) -> tuple[list[Paired], list[Driven], list[Mended]]:
    """Input and output of tests and baselines, and what was wrong with their samples."""
    several = [mended(r, f"test {i}") for i, r in enumerate(tests, 1)]
    rested = [mended(r, f"baseline {i}") for i, r in enumerate(baselines, 1)]
    data = _checked(spec, [m.recording for m in several])
    past = [_further(m.recording, spec, data[0].prescribed) for m in rested]
    for i, (one, other) in enumerate(zip(baselines, past, strict=True)):
        for mine, theirs in (
            (data[0].drive_channel, other.drive_channel),
            (data[0].answer_channel, other.answer_channel),
        ):
            if (mine.quantity, mine.unit) != (theirs.quantity, theirs.unit):
                where = place(one, "baseline", i, f"channels.{theirs.name}")
                message = f"measures something else than {place(tests[0], 'recording', 0, f'channels.{mine.name}')}"
                given, allowed = f"{theirs.quantity} {theirs.unit}", f"{mine.quantity} {mine.unit}"
                raise SpecError(Problem(field=where, message=message, given=given, allowed=allowed))
    own = _own(spec)
    data, past = ([with_bad(d, m) for d, m in zip(x, y, strict=True)] for x, y in ((data, several), (past, rested)))
    return (
        [paired(d, own, f"test {i}", past) for i, d in enumerate(data, 1)],
        [paired(d, own, f"baseline {i}").data for i, d in enumerate(past, 1)],
        [*several, *rested],
    )


def _own(spec: MachineSpec) -> float:
    """The machine file's natural angular frequency; that of 10 Hz where it has no spring."""
    return 2.0 * math.pi * (of_file(driven_site(spec))[1] or 10.0)


def reconcile_driven(
    spec: MachineSpec, tests: Sequence[Recording], baselines: Sequence[Recording] = (), *, seed: int = 0
) -> Report:
    """Reconcile an oscillator with recordings of its input and output.

    A lone recording is cut into consecutive thirds; of several, the one that goes farthest is held out. The linear
    model is calibrated on the recordings themselves; baselines tell whether units or channels have changed.
    """
    started = time.process_time()
    site = driven_site(spec)
    pairs, past, read = _read(spec, tests, baselines)
    data = [p.data for p in pairs]
    provenance: dict[str, object] = {"recordings": len(tests), "baselines": len(baselines)}
    lost = [m.hopeless((d.drive_channel.name, d.answer_channel.name)) for d, m in zip(data, read, strict=False)]
    gone = [fault for fault in lost if fault is not None]
    sound = [d for d, m in zip(past, read[len(tests) :], strict=True) if m.hopeless(_names(d)) is None]
    findings = [f for m in read for f in m.findings]
    if gone:
        report = fault_report(gone, NOT_JUDGED)
    elif data[0].prescribed:
        shown = [sensor_fault(f) for f in findings if _counts(f, data[0])]
        motions = held_motions(data, sound, shown)
        report = (
            fault_report(motions.faults, UNIT_NOT_KNOWN)
            if motions.undecided
            else reconcile_prescribed(spec, motions, seed=seed, provenance=provenance)
        )
    else:
        held = with_pairs(held_against(data, sound, site), pairs)
        if held.undecided:
            report = fault_report(held.faults, UNIT_NOT_KNOWN)
        else:
            found = analyse(parts_of(held.data), seed, held.rested)
            report = _held_up(answer(spec, found, seed=seed, provenance=provenance), found, held, site, seed)
            report = replace(report, where=replace(report.where, limits=(*report.where.limits, *held.remarks)))
            missing = report.verdict == "unknown_physics"
            shown = proved(findings, held.data, found.published, left_over(report, found) < ROUGH, missing)
            if share_kept(found.fitted_run) < LEAST_KEPT and shown:
                report = fault_report([*held.faults, *shown], NOT_JUDGED)
            else:
                report = either(beside(report, [*held.faults, *shown], held.data[0].drive_channel.name))
    return replace(
        report, provenance={**origin(seed, time.process_time() - started), **provenance, **report.provenance}
    )


def _held_up(report: Report, found: Analysis, held: Held, site: Site, seed: int) -> Report:
    """The report held against the noise, the baselines, and lines of forces that were not measured."""
    noise = noise_of(found.linear.model, found.fitted_run, found.linear.error, held.rested)
    report = settled(report, found, noise, site.body.name, seed, held.rested)
    report = beside_baseline(report, found, held.looks, held.rested, site, seed)
    return beside_tones(report, held.tones, held.data[0], site.body.name, noise)


def left_over(report: Report, found: Analysis) -> float:
    """Share of the output that the answer leaves: on held-out data where a law is named, else by the linear model."""
    if report.verdict == "explained" and report.held_out is not None:
        return report.held_out.after
    return found.fitted_nrmse if report.verdict == "nothing_missing" else 1.0


def _names(data: Driven) -> tuple[str, str]:
    return data.drive_channel.name, data.answer_channel.name


def _counts(found: Finding, data: Driven) -> bool:
    """Whether a finding is a sure fault of a test's prescribed motion, which may well stand still, or its force."""
    return found.kind == "not_finite" and found.channel in _names(data) and found.recording.startswith("test")
