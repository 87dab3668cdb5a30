"""Is a strong line of the signal itself new that no part of the machine makes? Whirl, a fan, a belt, another machine.

It modulates no tooth, strikes nothing and may be fixed to the shaft or to nothing: what is told is the line.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from reconcile.kinematics.families import Ties, ties
from reconcile.kinematics.lines import matched
from reconcile.kinematics.new_lines import SAME, NewLine, likely_cause, lines_of_test
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.spec import of_machine
from reconcile.machine.direct import DOUBT
from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.shares import percent
from reconcile.verdict import LineChange, NextExperiment, PlaceWeight
from sim.core.errors import SpecError
from sim.core.response import Channel
from sim.core.spec import MachineSpec


@dataclass(frozen=True, kw_only=True)
class OwnLine:
    """`strongest` of the new lines (`lines`) that are there at `speeds`: of how many at how many."""

    strongest: NewLine
    tie: Ties
    speeds: tuple[int, int]
    lines: tuple[LineChange, ...] = ()

    beside = ""
    """Beside another answer it is not told: high multiples of what is named are such lines too."""
    would_tell = NextExperiment(
        sentence="Record a run-up: it tells whether the line moves with the shaft, and look for what is not in the "
        "specification - an oil film, a fan, a belt, another machine."
    )
    electric = False
    strikes = False
    undecided = ()

    @property
    def follows(self) -> str:
        """What makes such lines."""
        cause = f" {likely_cause(self.strongest.order, self.tie)}" if self.strongest.open else ""
        return f"{self.strongest.made_by}{cause}"

    @property
    def text(self) -> str:
        """What is seen."""
        one, (seen, of) = self.strongest, self.speeds
        at = "" if of == 1 else f", at {'every speed' if seen == of else f'{seen} of {of} speeds'}"
        return (
            f"a line at {one.order:.3g} times the speed of {self.tie.reference} ({one.hz:.4g} Hz at "
            f"{one.speed_hz:.4g} Hz) is new on {one.channel}{at}, {one.growth_db:.0f} dB above the baseline and "
            f"{percent(one.share, 0)} of the power"
        )

    @property
    def stage(self) -> Mapping[str, object]:
        """For the report."""
        one = self.strongest
        return {"name": "own line", "order": one.order, "hz": one.hz, "channel": one.channel, "share": one.share}

    def sites(self, machine: MachineSpec) -> tuple[PlaceWeight, ...]:
        """Where the sensor stands that hears it best says little: all shafts alike."""
        return tuple(PlaceWeight(site=s.name, weight=1.0 / len(machine.shafts)) for s in machine.shafts)


def own_line(machine: MachineSpec, data: Sequence[PointData], channels: Sequence[Channel]) -> OwnLine | None:
    """None where no such line is at half of the speeds at one order, and without baselines."""
    try:
        tie = ties(of_machine(machine), machine.operating.shaft if machine.operating else None)
    except SpecError:  # shafts whose speeds nothing ties together
        return None
    found: list[tuple[NewLine, ...]] = []
    for k, one in enumerate(data, 1):
        now, then = one.spectra
        if then is None:
            continue
        test, base = (_plain(s, f"{k}", channels) for s in (now, then))
        if matched(test, [base]) is not None:
            found.append(tuple(one for one in lines_of_test(test, base, tie) if not one.bearing))
    every = [one for rows in found for one in rows]
    if not every:
        return None
    strongest = max(every, key=lambda one: (one.multiple is None, one.share))  # short records are near some multiple
    like = [[one for one in rows if abs(one.order / strongest.order - 1.0) < SAME] for rows in found]
    seen = sum(bool(rows) for rows in like)
    if 2 * seen < len(found):
        return None
    lines = tuple(
        LineChange(
            label=f"order {one.order:.4g}", frequency_hz=one.hz, change_db=one.growth_db, channel=one.channel,
            locked_to="", speed_hz=one.speed_hz,
        )
        for rows in like for one in rows
    )  # fmt: skip
    return OwnLine(strongest=strongest, tie=tie, speeds=(seen, len(found)), lines=lines)


def _plain(one: Steady, label: str, channels: Sequence[Channel]) -> Observation:
    """A recording at its steady speed, of which no envelope is asked."""
    speed = replace(one.estimate, speed_hz=one.speed_hz)
    return Observation(label=label, recording=one.recording(channels), speed=speed, doubt=DOUBT, channels=())
