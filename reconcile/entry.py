"""One door for all levels: what the machine's description and the channels allow decides which engine answers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from reconcile.atlas.bank import Mapper
from reconcile.atlas.candidates import Candidate, candidates
from reconcile.atlas.keep import Keeper
from reconcile.atlas.places import simulated_channels
from reconcile.driven import reconcile_driven
from reconcile.driven.machine import check_linear
from reconcile.grown_turns import with_grown_turns
from reconcile.kinematics import KinematicSpec, reconcile_kinematics
from reconcile.kinematics.whose_speed import check_whose_speeds
from reconcile.machine.budget import QUICK, Budget
from reconcile.machine.engine import Progress, reconcile_machine
from reconcile.one_names import by_one_name, same_in_another_order
from reconcile.overall import with_levels
from reconcile.pulses import check_pulses
from reconcile.repeated import check_repeated
from reconcile.report.revised import sent_to_the_file
from reconcile.stated import (
    Given,
    check_locations,
    check_shafts,
    check_speeds,
    check_turning,
    exchanged,
    given,
    pulses_hz,
    unplaced,
)
from reconcile.told import about, sent_as
from reconcile.unstated import unstated
from reconcile.unsteady import unsteady
from reconcile.verdict import Level, Report
from signals.recording import Operating, Recording
from sim.assembly.assemble import BUILT_IN
from sim.core.errors import Problem, SpecError
from sim.core.response import Channel
from sim.core.spec import MachineSpec

MOST_RECORDINGS = 24
"""Of each kind: bounds time and memory of a request."""
MOST_SAMPLES = 40_000_000
"""All channels of all recordings together."""


def _nothing(_share: float, _stage: str) -> None:
    return None


def check_size(tests: Sequence[Recording], baselines: Sequence[Recording]) -> None:
    """SpecError for nothing at all and for more than a request may ask."""
    problems = []
    if not tests:
        problems.append(
            Problem(field="recording", message="needs at least one recording", given=0, allowed="1 or more")
        )
    for name, several in (("recording", tests), ("baseline", baselines)):
        if len(several) > MOST_RECORDINGS:
            problems.append(
                Problem(field=name, message="too many", given=len(several), allowed=f"at most {MOST_RECORDINGS}")
            )
    samples = sum(r.samples.size for r in (*tests, *baselines))
    if samples > MOST_SAMPLES:
        message = "the recordings are too long together"
        problems.append(
            Problem(field="recording", message=message, given=samples, allowed=f"at most {MOST_SAMPLES} samples")
        )
    if problems:
        raise SpecError(problems)


def check_channels(tests: Sequence[Recording], baselines: Sequence[Recording]) -> None:
    """Channels, units and rates must agree between all recordings: nothing is matched by guess. The odd one out is
    told: what most have is right; where as many differ, both are told and neither is called wrong."""
    several = given(tests, baselines)
    often = Counter(_form(one.recording) for one in several)
    most = max(often.values())
    usual = next(one for one in several if often[_form(one.recording)] == most)
    sure = list(often.values()).count(most) == 1
    problems = [p for other in several if other is not usual for p in _unlike(usual, other, sure)]
    if problems:
        raise SpecError(problems)


def _form(one: Recording) -> tuple[object, ...]:
    return (round(one.sampling_rate_hz, 3), *map(_of_channel, one.channels))


def _of_channel(channel: Channel) -> tuple[str, ...]:
    """What must agree of two channels."""
    return (channel.location or "", channel.axis or "", channel.quantity, channel.unit)


def _unlike(usual: Given, other: Given, sure: bool) -> Iterator[Problem]:
    """What differs between two recordings, the first of them the usual one where that is `sure`."""
    here, there = [[_of_channel(c) for c in one.recording.channels] for one in (usual, other)]
    if here != there and sorted(here) == sorted(there):
        if not same_in_another_order(usual.recording, other.recording):
            yield _in_another_order(usual, other, sure)
        return
    beyond = _beyond(usual.recording, other.recording)
    if beyond:
        yield _more_or_fewer(usual, other, beyond, sure)
    for c, (a, b) in enumerate(() if beyond else zip(usual.recording.channels, other.recording.channels, strict=False)):
        if _of_channel(a) != _of_channel(b):
            said = [f"{x.location} {x.axis} {x.quantity} {x.unit}" for x in (a, b)]
            yield _differs(usual, other, f"channels[{c}]", said[0], said[1], sure)
    mine, theirs = usual.recording, other.recording
    if len(mine.channels) != len(theirs.channels) and not beyond:
        yield _differs(usual, other, "channels", len(mine.channels), len(theirs.channels), sure)
    if abs(theirs.sampling_rate_hz / mine.sampling_rate_hz - 1.0) > 1e-6:
        yield _differs(usual, other, "sampling_rate_hz", mine.sampling_rate_hz, theirs.sampling_rate_hz, sure, "Hz")


def _beyond(one: Recording, other: Recording) -> list[Channel]:
    """The channels that the longer list has and the shorter lacks, where all others are alike; by their names where
    these are the same, else by what must agree."""
    short, long = sorted((one.channels, other.channels), key=len)
    names = {c.name: _of_channel(c) for c in long}
    if all(names.get(c.name) == _of_channel(c) for c in short):
        kept = {c.name for c in short}
        return [c for c in long if c.name not in kept]
    left = Counter(map(_of_channel, short))
    beyond = []
    for c in long:
        if left[_of_channel(c)]:
            left[_of_channel(c)] -= 1
        else:
            beyond.append(c)
    return beyond if len(beyond) == len(long) - len(short) else []


def _more_or_fewer(usual: Given, other: Given, beyond: Sequence[Channel], sure: bool) -> Problem:
    """How many channels there are, and which of them the other has not."""
    count = [len(one.recording.channels) for one in (usual, other)]
    found = _differs(usual, other, "channels", count[0], count[1], sure)
    which = " and ".join(_named(c, by_name=False) for c in beyond)
    said = f"it lacks {which}" if count[1] < count[0] else f"it has {which} beyond the others"
    return replace(found, message=f"{found.message}; {said}")


def _in_another_order(usual: Given, other: Given, sure: bool) -> Problem:
    """The same channels in two orders: told by their names where those tell them apart, else by what differs."""
    names = [one.recording.names for one in (usual, other)]
    named = names[0] != names[1] and sorted(names[0]) == sorted(names[1])
    said = [", ".join(_named(c, named) for c in one.recording.channels) for one in (usual, other)]
    place = usual.field("channels")
    if sure:
        message = f"are the usual ones ({place}) in another order"
        return replace(_differs(usual, other, "channels", said[0], said[1], sure), message=message)
    message = f"are those of {place} in another order, which has {said[0]}: either may be wrong"
    return replace(_differs(usual, other, "channels", said[0], said[1], sure), message=message)


def _named(channel: Channel, by_name: bool) -> str:
    """`name`, or where that tells nothing `name at location axis quantity unit`."""
    return channel.name if by_name else f"{channel.name} at {' '.join(filter(None, _of_channel(channel)))}"


def _differs(
    usual: Given, other: Given, field: str, here: object, there: object, sure: bool, unit: str = ""
) -> Problem:
    """`there` is what the `other` recording has, `here` what the usual one has."""
    place, shown = usual.field(field), (f"{here:g}" if isinstance(here, float) else str(here))
    if sure:
        message = f"differs from most others' ({place})"
        return Problem(field=other.field(field), message=message, given=there, allowed=shown, unit=unit)
    message = f"differs from {place}, which has {shown}{f' {unit}' if unit else ''}: either may be wrong"
    return Problem(field=other.field(field), message=message, given=there, allowed="the same in both", unit="")


def check_descriptions(
    machine: MachineSpec | KinematicSpec, tests: Sequence[Recording], baselines: Sequence[Recording]
) -> None:
    """Shafts, places and speeds that the descriptions state must be those of the machine; speeds are in Hz."""
    several = given(tests, baselines)
    check_shafts([s.name for s in machine.shafts], several)
    check_turning(several)
    if isinstance(machine, KinematicSpec):
        if _has_places(machine):
            check_locations(machine.parts, several)
        speeds, field = {s.name: s.speed_hz for s in machine.shafts}, "kinematics.shafts.{shaft}.speed_hz"
    else:
        with about(tests[0].label):
            simulated_channels(machine, tests[0].channels)
        operating = machine.operating
        speeds = {operating.shaft: operating.speed_hz} if operating is not None else {}
        field = "machine.operating.speed_hz"
    check_speeds(speeds, field, several)


def _has_places(machine: KinematicSpec) -> bool:
    """A file of shafts alone has no place to name."""
    return len(machine.parts) > len(machine.shafts)


def reconcile_recordings(
    machine: MachineSpec | KinematicSpec,
    tests: Sequence[Recording],
    baselines: Sequence[Recording] = (),
    *,
    budget: Budget = QUICK,
    keeper: Keeper | None = None,
    mapper: Mapper = map,
    seed: int = 0,
    progress: Progress = _nothing,
    nominated: Sequence[Candidate] | None = None,
) -> Report:
    """Reconcile recordings with what is known of their machine.

    A machine without shafts is driven by a measured input; kinematics alone allow names and feature-level gains; a
    machine that can be simulated allows all stages, and there `nominated` may limit the effects considered. SpecError
    says what cannot be reconciled and why.
    """
    check_size(tests, baselines)
    sent = sent_as(tests, baselines)
    if isinstance(machine, MachineSpec) and not machine.shafts:
        check_linear(machine)
        check_repeated(tests, baselines)
        report = reconcile_driven(machine, tests, baselines, seed=seed)
        return _with_labels(report, sent, machine.name)
    check_descriptions(machine, tests, baselines)
    check_channels(tests, baselines)
    (tests, baselines), renamed = by_one_name(tests, baselines)
    check_repeated(tests, baselines)
    if isinstance(machine, KinematicSpec):
        check_whose_speeds(machine, given(tests, baselines))
        check_pulses(given(tests, baselines), machine)
    level: Level = "kinematics" if isinstance(machine, KinematicSpec) else "machine"
    stated = given(tests, baselines)
    if isinstance(machine, MachineSpec):
        tests, baselines = ([_turning(machine, one) for one in several] for several in (tests, baselines))
    if isinstance(machine, KinematicSpec):
        progress(0.0, "held speed")
    smeared = unsteady(tests, baselines, level, seed)
    if smeared is not None:
        return _with_labels(with_levels(smeared, tests, baselines), sent, machine.name)
    if isinstance(machine, KinematicSpec):
        report = reconcile_kinematics(machine, tests, baselines, seed=seed, progress=progress)
        remarks = unplaced(machine.parts, stated) if _has_places(machine) else ()
        remarks = (*remarks, *unstated(stated, report), *exchanged(stated), *renamed)
        report = with_levels(_with_limits(report, remarks), tests, baselines)
        return _with_labels(report, sent, machine.name)
    report = reconcile_machine(
        machine, tests, baselines, budget=budget, keeper=keeper, mapper=mapper, seed=seed, progress=progress,
        nominated=nominated,
    )  # fmt: skip
    report = with_grown_turns(report, machine, tests, baselines, seed)
    remarks = (*unstated(stated, report), *exchanged(stated), *already_there(machine), *renamed)
    report = with_levels(sent_to_the_file(_with_limits(report, remarks)), tests, baselines)
    return _with_labels(report, sent, machine.name)


def _turning(machine: MachineSpec, recording: Recording) -> Recording:
    """A recording that states no speed, at the mean of its pulses, else at the machine's own speed."""
    own = machine.operating
    if own is None or recording.operating is not None:
        return recording
    speed_hz = pulses_hz(recording, own.shaft) or own.speed_hz
    return replace(recording, operating=Operating(shaft=own.shaft, speed_hz=speed_hz))


def already_there(machine: MachineSpec) -> tuple[str, ...]:
    """Effects that the machine has: those with a size are candidates that may have grown, the others are not looked
    for."""
    own = [t for t in machine.terms if t.term not in BUILT_IN]
    looked = {(c.term, c.site) for c in candidates(machine)}
    has = [f"{t.term.replace('_', ' ')} at {t.site}" for t in own if (t.term, t.site) not in looked]
    return (f"not looked for is whether what the machine has already changed: {', '.join(has)}",) if has else ()


def _with_limits(report: Report, remarks: Sequence[str]) -> Report:
    return replace(report, where=replace(report.where, limits=(*report.where.limits, *remarks)))


def _with_labels(report: Report, sent: Mapping[str, str], name: str) -> Report:
    """The report, which says of which machine it is and what it calls each recording."""
    return replace(
        report, provenance={**report.provenance, "machine": name, **({"sent_as": dict(sent)} if sent else {})}
    )
