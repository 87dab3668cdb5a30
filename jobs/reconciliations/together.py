"""Whether machine, recordings and baselines can go together at all, by what is said of them.

The engine's own checks are asked, those that it makes before it looks at samples: what it refuses there it refuses
whatever was measured. All that hangs on samples is left to it, and so is every doubt that it answers with a verdict
(`measurement_fault` of exchanged or loose sensors ...).
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from jobs.reconciliations.machine import Known
from jobs.validation import Findings
from reconcile.atlas.places import simulated_channels
from reconcile.driven.engine import check_rates
from reconcile.driven.machine import check_linear
from reconcile.entry import check_channels
from reconcile.kinematics import KinematicSpec
from reconcile.stated import (
    FAST_HZ,
    FASTER,
    Given,
    check_locations,
    check_shafts,
    check_speeds,
    check_turning,
    given,
    pulses_hz,
    sixty_times,
)
from reconcile.told import about
from signals.recording import Recording
from sim.core.errors import Problem, SpecError

_PLACE = re.compile(r"\b((?:recordings|baselines)\.\d+): ")
_INDEX = re.compile(r"\[(\d+)\]")


def check_together(known: Known, tests: Sequence[Recording], baselines: Sequence[Recording]) -> None:
    """SpecError with every field of the request that keeps these from going together.

    The recordings are labelled by their place in the request (`baselines.0`); their samples are not looked at.
    """
    findings = Findings()
    if not isinstance(known, KinematicSpec) and not known.shafts:
        # Driven by a measured input: channels are matched by what they measure.
        with findings.step():
            check_linear(known)
        with findings.step():
            check_rates(tests)
        return _settle(findings)
    several = given(tests, baselines)
    with findings.step():
        check_shafts([shaft.name for shaft in known.shafts], several)
    with findings.step():
        check_turning(several)
    with findings.step():
        _check_places(known, tests, several)
    with findings.step():
        _check_speeds(known, several)
    with findings.step():
        check_channels(tests, baselines)
    return _settle(findings)


def _settle(findings: Findings) -> None:
    """SpecError with all that was found, by fields of the request."""
    try:
        findings.settle()
    except SpecError as error:
        raise SpecError([_of_request(problem) for problem in error.problems]) from None


def _check_places(known: Known, tests: Sequence[Recording], several: Sequence[Given]) -> None:
    """Locations of channels, as the engine asks for them at this level."""
    if not isinstance(known, KinematicSpec):
        with about(tests[0].label):
            simulated_channels(known, tests[0].channels)
    elif len(known.parts) > len(known.shafts):
        check_locations(known.parts, several)


def _check_speeds(known: Known, several: Sequence[Given]) -> None:
    """Speeds in rpm, where no line of a shaft could confirm them."""
    if isinstance(known, KinematicSpec):
        nominal = {shaft.name: shaft.speed_hz for shaft in known.shafts}
    else:
        nominal = {known.operating.shaft: known.operating.speed_hz} if known.operating is not None else {}
    try:
        check_speeds(nominal, "{shaft}", several)
    except SpecError as error:
        places = {one.field("operating.speed_hz"): one.recording for one in several}
        sure = [p for p in error.problems if p.field in places and _certain(places[p.field])]
        own = [p for p in error.problems if p.field in nominal and _own_certain(p.field, nominal[p.field], several)]
        if sure or own:
            raise SpecError([*sure, *(replace(p, field=_of_machine(p.field, known)) for p in own)]) from None


def _of_machine(shaft: str, known: Known) -> str:
    """Where the request has the shaft's nominal speed."""
    if isinstance(known, KinematicSpec):
        return f"machine.kinematics.shafts.{[s.name for s in known.shafts].index(shaft)}.speed_hz"
    return "machine.operating.speed_hz"


def _own_certain(shaft: str, nominal_hz: float | None, several: Sequence[Given]) -> bool:
    """Whether the engine refuses a shaft's nominal speed whatever lines it finds: pulses count a sixtieth, a recording
    states one and the speed is faster than machines turn, or nothing tells it and it is above half a sampling rate."""
    if nominal_hz is None:
        return False
    told = False
    for recording in (one.recording for one in several):
        pulses, operating = pulses_hz(recording, shaft), recording.operating
        stated = operating.speed_hz if operating is not None and operating.shaft == shaft else 0.0
        speed = pulses or stated
        told |= speed > 0.0
        if speed > 0.0 and sixty_times(nominal_hz, speed) and (pulses or nominal_hz > FAST_HZ * FASTER):
            return True
    return not told and any(nominal_hz >= one.recording.sampling_rate_hz / 2 for one in several)


def _certain(recording: Recording) -> bool:
    """Whether the engine refuses the stated speed whatever lines it finds: pulses say another, it is above half the
    sampling rate, or faster than machines turn."""
    operating = recording.operating
    if operating is None:
        return False
    too_fast = operating.speed_hz > FAST_HZ * FASTER or operating.speed_hz >= recording.sampling_rate_hz / 2
    return too_fast or pulses_hz(recording, operating.shaft) is not None


def _of_request(problem: Problem) -> Problem:
    """The problem with its field as a path into the request, and the places in its words alike."""
    field = _INDEX.sub(r".\1", _PLACE.sub(r"\1.", problem.field))
    return replace(problem, field=field, message=_PLACE.sub(r"\1.", problem.message))
