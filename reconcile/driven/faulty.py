"""Faults of the measurement at level `driven`: found, put right where that is possible, reported."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from reconcile.driven.added import Added, Tone, without_added
from reconcile.driven.added import faults as added_faults
from reconcile.driven.channels import Driven
from reconcile.driven.machine import Site
from reconcile.driven.measured import (
    Look,
    against_file,
    clock_fault,
    clocked,
    exchanged,
    look,
    remarks,
    scaled,
    swap_fault,
    turned_against,
    turned_fault,
)
from reconcile.driven.skew import skewed
from reconcile.driven.step import late_fault, stepped
from reconcile.faults import with_faults
from reconcile.gate.spoiled import fault_sentence
from reconcile.verdict import NextExperiment, Report, SensorFault

UNIT_NOT_KNOWN = ("Mass, stiffness and any law would be in unknown units: nothing is said of the machine.",)
QUIET = ("nothing_missing", "not_decidable")


@dataclass(frozen=True, kw_only=True)
class Held:
    """Recordings held against each other and the machine file: with what could be put right, faults and remarks.

    `undecided`: something is wrong that could not be put right.
    """

    data: list[Driven]
    faults: list[SensorFault]
    remarks: tuple[str, ...]
    undecided: bool
    looks: tuple[Look, ...] = ()
    rested: tuple[Look, ...] = ()
    """The models that tests and baselines fit, of what was put right."""
    tones: tuple[tuple[str, Tone], ...] = ()
    """Lines of forces that were not measured, with their recording; they are taken off."""


def held_against(tests: Sequence[Driven], baselines: Sequence[Driven], site: Site) -> Held:
    """Channels exchanged, then units: against the first baseline, else the machine file, else the first test."""
    faults, apart, undecided = list[SensorFault](), list[str](), False
    heard = [_straight(d, f"test {i}", faults, apart) for i, d in enumerate(tests, 1)]
    looks = [one.look for one in heard]
    rested = [_straight(d, f"baseline {i}", [], []).look for i, d in enumerate(baselines, 1)]
    for i, one in enumerate(looks):
        if one.data.moved:
            continue
        if rested:
            found, against = scaled(one, rested[0]), "baseline 1"
        else:
            found, against = against_file(one, site), "the machine file"
            if found is None and i > 0:
                found, against = scaled(one, looks[0]), "test 1"
        if found is None:
            continue
        faults.append(found.fault(one.data, f"test {i + 1}", against))
        undecided |= found.drives is None or against == "test 1"
        looks[i] = look(found.undone(one.data))
    looks, turned, unlike = _turned_and_clocked(looks, rested)
    faults += turned
    undecided |= unlike
    said = () if faults else remarks(looks, site)
    return Held(
        data=[one.data for one in looks],
        faults=faults,
        remarks=(*said, *apart),
        undecided=undecided,
        looks=tuple(looks),
        rested=tuple(rested),
        tones=tuple((f"test {i}", tone) for i, one in enumerate(heard, 1) for tone in one.tones),
    )


def _turned_and_clocked(looks: Sequence[Look], rested: Sequence[Look]) -> tuple[list[Look], list[SensorFault], bool]:
    """The tests with sign and sampling rate of the first baseline; whether their rates, put right, are then unlike."""
    seen, faults = list(looks), list[SensorFault]()
    for i, one in enumerate(seen if rested else ()):
        name = f"test {i + 1}"
        if not one.data.moved and turned_against(one, rested[0]):
            faults.append(turned_fault(one.data, name, "baseline 1"))
            seen[i] = look(replace(one.data, answer=-one.data.answer))
        factor = clocked(one, rested[0])
        if factor is not None:
            faults.append(clock_fault(one.data, factor, name, "baseline 1"))
            seen[i] = look(replace(seen[i].data, step_s=one.data.step_s * factor))
    rates = {round(1e9 * one.data.step_s) for one in seen}
    return seen, faults, len(rates) > 1


def _straight(data: Driven, recording: str, faults: list[SensorFault], apart: list[str]) -> Added:
    """The look with force and motion as they are, in step, and without what was added to the motion; what is only said
    of its timing is added to `apart`."""
    one = look(data) if data.moved else _unswapped(look(data), recording, faults, apart)
    found = without_added(one)
    faults.extend(added_faults(found, one.data, recording))
    return found


def _unswapped(one: Look, recording: str, faults: list[SensorFault], apart: list[str]) -> Look:
    """The look with force and motion as they are, and in step; what was wrong is added to `faults`."""
    other, shifted = exchanged(one), stepped(one, recording)
    if shifted is not None and (other is None or shifted[0].left <= other.left):
        faults.append(shifted[1])
        return shifted[0]
    if other is not None:
        faults.append(swap_fault(one, other, recording))
        return other
    skew = skewed(one)
    if skew is None:
        return one
    if abs(skew.samples) < 1.0:
        apart.append(skew.remark(recording))
    else:
        faults.append(late_fault(one.data, skew.delay_s, recording))
    return skew.look


def fault_report(faults: Sequence[SensorFault], undecidable: tuple[str, ...]) -> Report:
    """The answer where the measurement does not carry an analysis."""
    report = Report(
        verdict="measurement_fault",
        sentence=fault_sentence(faults[0], heard=False),
        level="driven",
        fault=faults[0],
        undecidable=undecidable,
        next_experiment=NextExperiment(sentence="Correct the description or the channel, or cut the sound part out."),
        stages=({"stage": "gate", "findings": [_said(f) for f in faults]},),
    )
    return with_faults(report, faults)


def beside(report: Report, faults: Sequence[SensorFault], force: str = "") -> Report:
    """The report with faults that were put right or left out; the answer where nothing else is missing or decidable.

    `force`: the channel that drives; where it is cut off it drives no model, and what is missing may be that alone.
    """
    found = [{"stage": "gate", "findings": [_said(f) for f in faults] or ["nothing wrong with the measurement"]}]
    report = replace(report, stages=(*found, *report.stages))
    if not faults:
        return report
    cut = any(f.kind == "clipped" and f.channel == force for f in faults)
    if report.verdict not in QUIET and not cut:
        return with_faults(report, faults)
    rest = (
        " Apart from it the linear model explains the recordings."
        if report.verdict == "nothing_missing" and not cut
        else ""
    )
    said = f"{fault_sentence(faults[0], heard=False)}{rest}"
    causes = tuple(replace(c, named=False) for c in report.causes)
    answer = replace(report, verdict="measurement_fault", sentence=said, fault=faults[0], causes=causes)
    return with_faults(answer, faults)


def _said(fault: SensorFault) -> str:
    return f"{fault.channel}: {fault.kind}, {fault.detail}" if fault.channel else f"{fault.kind}, {fault.detail}"
