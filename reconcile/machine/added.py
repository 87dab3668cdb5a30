"""What effects add at one operating point to the motion of machines that agree with the baseline."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reconcile.atlas.plan import AtlasPlan, Draw, Point, simulated_at
from reconcile.atlas.run import run_members
from reconcile.machine.motion import added_motion
from reconcile.machine.setting import Setting
from signals.series import FloatArray
from sim.core.spec import TermSpec


@dataclass(frozen=True, kw_only=True)
class Place:
    """An operating point and what is heard there; `rows` of the simulated `channels` are those of the recording."""

    plan: AtlasPlan
    point: Point
    channels: tuple[str, ...]
    rows: tuple[int, ...]

    def added(self, terms: Sequence[TermSpec], machine: int | None = None) -> list[FloatArray | None]:
        """Motion (C, n) that each adds to a machine, one after the other or all to `machine`; None where one does not
        run or adds nothing."""
        return self.added_by([terms], machine)[0]

    def added_by(
        self, effects: Sequence[Sequence[TermSpec]], machine: int | None = None
    ) -> list[list[FloatArray | None]]:
        """The same of several effects, each of which has as many draws."""
        draws = max(map(len, effects), default=0)
        machines = [k % len(self.plan.offsets) if machine is None else machine for k in range(draws)]
        distinct = sorted(set(machines))
        alone = run_members([self.plan.member(Draw(pair=k), self.point) for k in distinct], self.channels)
        rested = dict(zip(distinct, alone, strict=True))
        found = []
        for terms in effects:
            pairs = machines[: len(terms)]
            members = [self.plan.member(Draw(pair=k, term=t), self.point) for k, t in zip(pairs, terms, strict=True)]
            struck = run_members(members, self.channels)
            added = [added_motion(one, rested[k]) for one, k in zip(struck, pairs, strict=True)]
            found.append([None if a is None else a[list(self.rows)] for a in added])
        return found


def place_at(setting: Setting, point: int) -> Place:
    """That of a point of the setting."""
    channels = tuple(sorted(set(setting.simulated)))
    return Place(
        plan=setting.plan,
        point=simulated_at(setting.machine, setting.data[point].point),
        channels=channels,
        rows=tuple(channels.index(c) for c in setting.simulated),
    )
