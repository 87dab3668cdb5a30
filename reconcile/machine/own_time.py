"""Does something keep its own time? Lines of the teeth modulated at a frequency that stays in Hz at every speed.

Torque or pull of an electric drive at twice the supply's frequency, a pump or another machine that shakes the housing:
what acts inside the machine so makes sidebands of the teeth's lines at a distance in Hz, which no order finds and which
hum picked up by a cable does not have. Where speeds differ the same distance at all of them is none of the machine's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.kinematics.families import Family
from reconcile.machine.parts_in_hz import OWN_HZ, beside_a_part, of_a_part, of_parts, parts_of
from reconcile.machine.sidebands import APART, HIGHEST_SHARE, apart, in_reach, rise, risen_lines, second, teeth_of
from reconcile.observe.observation import PointData
from reconcile.verdict import LineChange, NextExperiment, PlaceWeight
from signals.series import FloatArray
from sim.core.spec import MachineSpec

LOWEST_HZ, HIGHEST_HZ, STEP_HZ = 12.0, 260.0, 0.4
"""Nearer to the teeth's lines there is what is left of the speed's wander."""
LOW, BESIDE = 6, 0.5
"""A multiple of a shaft up to the first is its own; a higher one where those beside it, or every second to sixth one
about it, have risen so much as well: a broken tooth raises them all, several damaged ones or a jaw coupling every so
many, and of a slow shaft some multiple lies near any frequency."""
LEAST_DB, AHEAD = 1.2, 2.0
"""Mean rise at the speed where it is least, and over that at any frequency elsewhere. Sound machines of the proof's
third split come to 0.3 dB; a pit's forest of lines to 3.5 dB, but at many frequencies."""
LEAST_AT_TWO_DB = 2.5
"""And of three speeds or more at that where it is largest but one: at some speed the drive's path may be deaf."""
FAINT_DB = 0.6
"""Rise at the speed where it is least from which that speed confirms what the others show: twice what sound machines
come to. Lines of parts may meet at two speeds; a torque of 100 Hz (v040 of the proof, 4.5 dB at the speed where it is
largest but one, 1.1 dB at the last) stood where both races' do."""
SUPPLY_AT_TWO_DB, SUPPLY_FAINT_DB = 1.5, 0.4
"""The same two at once or twice a supply's frequency, where an electric drive is expected to act: a pull of 100 Hz
(j057 of the proof) has 17, 1.9 and 0.6 dB at three speeds, at two of which both races' lines stand; 24 sound machines
come to 0.23 dB there at two speeds and to 0.13 dB at all."""
AT_ONE_DB, AHEAD_AT_ONE = 8.0, 2.5
"""And so where one speed alone was recorded: a torque at 100 Hz (c067 of the proof) has 22 dB, 3.2 times what rose most
elsewhere. Of 76 operating points of sound machines, each taken alone, none shows 1 dB at such a frequency, of 212 with
one or two effects one 9.6 dB, with 8.1 elsewhere: a pit of a ball."""
MOST_SLIP = 0.005
"""Share by which an order of balls that slip may differ between two speeds."""
HALF = 0.5
"""Share of that rise from which on a speed shows it."""
SEPARATE_HZ, SKIRT_HZ = 3.0, 5.0
SUPPLIES_HZ = (50.0, 60.0)
SUPPLY_HZ = 1.0
OFF = NextExperiment(
    sentence="Switch the drive off and record the run-down: what a drive brings is gone at once, what another machine "
    "brings stays."
)


@dataclass(frozen=True, kw_only=True)
class OwnTime:
    """`hz`: distance of the sidebands; `rise_db` over the baseline, mean of channels, teeth's harmonics and sides at
    the speed where it is least (largest but one, if a speed is deaf to it); `elsewhere_db`: the largest such rise at
    any other frequency; `speeds`: at how many of how many it has risen."""

    hz: float
    rise_db: float
    elsewhere_db: float
    lines: tuple[LineChange, ...] = ()
    speeds: tuple[int, int] = (2, 2)

    beside = "no order of this machine"
    would_tell = OFF
    electric = True
    strikes = False
    undecided = ()

    @property
    def follows(self) -> str:
        """What turns so."""
        if self.speeds[1] > 1:
            return "It follows no shaft of this machine."
        return "No line of a shaft or a bearing of this machine is there at this speed; another tells whether it stays."

    @property
    def supply_hz(self) -> float | None:
        """The supply of which it is once or twice the frequency."""
        return _supply(self.hz)

    @property
    def text(self) -> str:
        """What is seen."""
        seen, of = self.speeds
        at = "at every speed" if seen == of else f"at {seen} of {of} speeds"
        at = at if of > 1 else "at the one speed recorded"
        text = f"the teeth's lines are modulated at {self.hz:.4g} Hz {at}, new since the baseline"
        if self.supply_hz is None:
            return text
        return f"{text}; a supply of {self.supply_hz:g} Hz would do that through torque or pull of an electric drive"

    @property
    def stage(self) -> Mapping[str, object]:
        """For the report."""
        return {"name": "own time", "hz": self.hz, "rise_db": self.rise_db, "elsewhere_db": self.elsewhere_db}

    def sites(self, machine: MachineSpec) -> tuple[PlaceWeight, ...]:
        """The driven shaft, by which a drive acts, before the gears, at which something may pull."""
        shaft = machine.operating.shaft if machine.operating is not None else machine.shafts[0].name
        share = 0.5 / max(1, len(machine.gears))
        return (
            PlaceWeight(site=shaft, weight=0.5),
            *(PlaceWeight(site=gear.name, weight=share) for gear in machine.gears),
        )


def own_time(machine: MachineSpec, data: Sequence[PointData], channels: Sequence[str]) -> OwnTime | None:
    """None where nothing of the kind stands out, and without baselines; at one speed only what a supply would bring is
    sought, and it must stand out much farther."""
    speeds = [d.point.speed_hz for d in data]
    groups = apart(speeds)
    if not data or any(d.spectra[1] is None for d in data):
        return None
    teeth = teeth_of(machine)
    slowest = min((float(d.lines_hz[k]) for d in data for k in teeth.meshes), default=0.0)
    grid = np.arange(LOWEST_HZ, min(HIGHEST_HZ, HIGHEST_SHARE * slowest), STEP_HZ)
    reached = in_reach(data, teeth.meshes, [float(grid[-1])] * len(data)) if grid.size > 1 else []
    if not reached:
        return None
    rises = np.stack([rise(d, reached, grid) for d in data])
    mean = rises.mean(axis=(1, 2))
    parts = parts_of(machine)
    sized = {f.site for f in parts if f.kind == "outer"}
    search = _Search(
        data=data, shafts=teeth.shafts, parts=parts, mean=mean, grid=grid,
        complete=all(b.name in sized for b in machine.bearings),
    )  # fmt: skip
    found = search.found(groups)
    if found is None:
        return None
    best, seen = found
    risen = [k for k in range(len(data)) if mean[k, best] >= HALF * seen.rise_db]
    locked = "mains" if seen.supply_hz else ""
    mesh = reached[0][0]
    lines = [
        line
        for k in risen
        for line in risen_lines(data[k], mesh, rises[k, ..., best], seen.hz, f"{seen.hz:.4g} Hz", locked, channels)
    ]
    count = sum(any(k in risen for k in group) for group in groups)
    return replace(seen, lines=tuple(lines), speeds=(count, len(groups)))


@dataclass(frozen=True, kw_only=True)
class _Search:
    """`mean` (speeds, grid): what has risen, dB; `shafts`: numbers of their first lines; `supply`: whether only what a
    supply would bring is sought; `complete`: whether the lines of all bearings are known."""

    data: Sequence[PointData]
    shafts: Sequence[int]
    parts: Sequence[Family]
    mean: FloatArray
    grid: FloatArray
    supply: bool = False
    complete: bool = True

    def found(self, groups: Sequence[Sequence[int]]) -> tuple[int, OwnTime] | None:
        """What stands out at the speeds of these operating points, with its number in the grid."""
        of_supply = replace(self, supply=True)
        if len(groups) == 1 and self.complete:
            return of_supply.standing(self.mean.mean(axis=0), AT_ONE_DB, at_one=True)
        found = self.standing(self.mean.min(axis=0), LEAST_DB) if len(groups) > 1 else None
        if found is not None or len(groups) < 3:
            return found
        two = second(self.mean, groups)
        found = self.standing(two, LEAST_AT_TWO_DB, at_two=True)
        return found or of_supply.standing(two, SUPPLY_AT_TWO_DB, at_two=True)

    def standing(
        self, least: FloatArray, least_db: float, *, at_two: bool = False, at_one: bool = False
    ) -> tuple[int, OwnTime] | None:
        """The frequency of no order that stands out by `least` (grid,), dB, with its number in the grid; `at_two`
        speeds alone two orders may meet, `at_one` it must be no order of any part."""
        left, known = least.copy(), np.zeros(self.grid.size, dtype=bool)
        while left.max() >= least_db:
            best = int(np.argmax(left))
            hz = _middle(self.grid, left, best)
            risen = [k for k in range(len(self.data)) if self.mean[k, best] >= HALF * left[best]]
            data = [self.data[k] for k in risen]
            two = at_two and not self._everywhere(best)
            free = self._of_no_part(hz, risen, at_one=at_one)
            free = free and not (two and (of_parts(data, self.parts, hz) or self._orders(hz, risen, left[best])))
            free = free and _falls(self.grid, least, best, hz) and not of_a_part(data, self.parts, hz)
            if free and (_supply(hz) is not None or not self.supply):
                break
            near = np.abs(self.grid - hz) <= SEPARATE_HZ
            left[near] = 0.0
            known |= near & (not free)  # an order, with what its line leaks
        else:
            return None
        away = ~known
        for multiple in (1 / 3, 0.5, 1.0, 2.0, 3.0):
            away &= np.abs(self.grid - multiple * hz) > SEPARATE_HZ
        elsewhere = float(least[away].max(initial=0.0))
        if least[best] < max(least_db, (AHEAD_AT_ONE if at_one else AHEAD) * elsewhere):
            return None
        return best, OwnTime(hz=hz, rise_db=float(least[best]), elsewhere_db=elsewhere)

    def _of_no_part(self, hz: float, risen: Sequence[int], *, at_one: bool) -> bool:
        """Whether it is no order of a shaft, and at one speed no line of a bearing either."""
        data = [self.data[k] for k in risen]
        if not at_one:
            return _free(data, self.shafts, hz, self.mean[risen], self.grid)
        turns = [float(d.lines_hz[k]) for d in data for k in self.shafts]
        near = [min(OWN_HZ, 0.25 * turn) for turn in turns]
        if any(abs(hz - max(1, round(hz / turn)) * turn) <= off for turn, off in zip(turns, near, strict=True)):
            return False
        if of_parts(data, self.parts, hz):
            return False
        return not any(
            beside_a_part(self.data[k], self.parts, hz, self.grid, self.mean[k], HALF * self._at(k, hz)) for k in risen
        )

    def _at(self, point: int, hz: float) -> float:
        return float(self.mean[point, int(np.argmin(np.abs(self.grid - hz)))])

    def _everywhere(self, best: int) -> bool:
        """Whether every speed shows it, one of them faintly."""
        every = self.mean.min(axis=0)
        away = np.abs(self.grid - self.grid[best]) > SEPARATE_HZ
        faint = SUPPLY_FAINT_DB if self.supply else FAINT_DB
        return bool(every[best] >= max(faint, AHEAD * every[away].max(initial=0.0)))

    def _orders(self, hz: float, risen: Sequence[int], level_db: float) -> bool:
        """Whether what has risen at a speed has risen at the same order of another too."""
        speeds = [d.spectra[0].speed_hz for d in self.data]
        for k in risen:
            for j, speed_hz in enumerate(speeds):
                at = hz * speed_hz / speeds[k]
                near = np.abs(self.grid - at) <= OWN_HZ + MOST_SLIP * at
                if abs(at - hz) > SEPARATE_HZ and self.mean[j, near].max(initial=0.0) >= HALF * level_db:
                    return True
        return False


def _supply(hz: float) -> float | None:
    """The supply of which a frequency is once or twice its own."""
    return next((s for s in SUPPLIES_HZ for k in (1, 2) if abs(hz - k * s) < SUPPLY_HZ), None)


def _middle(grid: FloatArray, least: FloatArray, best: int) -> float:
    """Centre of what stands out around the best, Hz: a line may be split by the speed's wander."""
    near = (np.abs(grid - grid[best]) <= SEPARATE_HZ) & (least > 0.5 * least[best])
    return float(np.average(grid[near], weights=least[near]))


def _falls(grid: FloatArray, least: FloatArray, best: int, hz: float) -> bool:
    """Whether less has risen a little nearer to the teeth's lines than at a line about `hz`: their own skirts, which
    the speed's wander widens, rise towards them. Beside an eccentric gear (h100 of the proof) 12.2 Hz stood out so, at
    the end of the search. Lines are up to four bins wide at their foot."""
    near = (grid <= grid[best]) & (grid >= hz - SKIRT_HZ)
    return bool(least[near].min() < HALF * least[best])


def _free(data: Sequence[PointData], shafts: Sequence[int], hz: float, mean: FloatArray, grid: FloatArray) -> bool:
    """Whether a frequency is at two speeds at least no order of a shaft: those of two speeds may meet. `mean`
    (speeds, grid): what has risen, dB."""
    clear = [
        d.point.speed_hz
        for d, risen in zip(data, mean, strict=True)
        if not any(_an_order(float(d.lines_hz[k]), hz, risen, grid) for k in shafts)
    ]
    return bool(clear) and max(clear) > APART * min(clear)


def _an_order(turn_hz: float, hz: float, risen: FloatArray, grid: FloatArray) -> bool:
    """Whether a frequency is a multiple of a shaft's that is low, or stands among others that have risen too."""
    number, quarter = max(1, round(hz / turn_hz)), 0.25 * turn_hz
    apart = abs(hz - number * turn_hz)
    if number <= LOW and apart <= min(OWN_HZ, quarter):
        return True
    near = min(SEPARATE_HZ, quarter)

    def most(at_hz: float) -> float:
        return float(risen[np.abs(grid - at_hz) <= near + STEP_HZ].max(initial=0.0))

    def in_comb(every: int) -> bool:
        beside = [most(k * turn_hz) for k in (number - every, number + every) if k > 0 and k * turn_hz < grid[-1]]
        return bool(beside) and min(beside) >= BESIDE * most(hz)

    return apart <= near and any(in_comb(every) for every in range(1, LOW + 1) if number % every == 0)
