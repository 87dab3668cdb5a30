"""What one reconciliation stands on, and what its candidates say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from reconcile.atlas.bank import Bank
from reconcile.atlas.plan import AtlasPlan
from reconcile.calibrate.uncertain import Offsets, moved
from reconcile.judge.changes import Changes, Lens
from reconcile.judge.screen import Screen
from reconcile.judge.space import LEAST_OVERDISPERSION, Fitted
from reconcile.machine.direct import NOTHING, Direct
from reconcile.machine.library import Catalogued
from reconcile.observe.observation import PointData
from sim.core.spec import MachineSpec


@dataclass(frozen=True, kw_only=True)
class Lone:
    """The channel that changed at one operating point alone, and the chance of its change in a sound machine."""

    channel: str
    point: str
    p: float


@dataclass(frozen=True, kw_only=True)
class Setting:
    """What one reconciliation stands on."""

    machine: MachineSpec
    data: tuple[PointData, ...]
    channels: tuple[str, ...]
    simulated: tuple[str, ...]
    plan: AtlasPlan
    banks: tuple[Bank, ...]
    seen_through: tuple[Lens, ...]
    changes: Changes
    seed: int
    direct: Direct = NOTHING
    overdispersion: float = LEAST_OVERDISPERSION
    """At least that of the atlas, whose many effects on many machines know it best."""
    fitted_machine: MachineSpec | None = None
    """The mean of the machines that agree with the baseline."""
    lone: Lone | None = None
    """A sensor that changed at one operating point alone, whose features are not compared."""


@dataclass(frozen=True, kw_only=True)
class Found:
    """What the candidates say."""

    known: Catalogued
    fitted: Fitted
    screen: Screen
    fine: Fitted | None = None
    """The view of single lines (the teeth's; without teeth the shafts' and passing balls'), on machines that agree with
    the baseline."""
    sides: Fitted | None = None
    """The view of single sidebands there."""
    twice: Fitted | None = None
    """The view of single second sidebands there."""
    phases: tuple[Fitted, ...] = ()
    """The first two with the phases between sensors, where these are compared."""
    before: Catalogued | None = None
    """The draws that were not led to the observation, where others were."""
    led: Mapping[str, Offsets] = field(default_factory=dict)
    """Of effects that were fitted together with the machine: its mean offsets then."""

    @property
    def unled(self) -> Catalogued:
        """Draws that know nothing of what was observed but where the best lie: for held-out data and comparisons."""
        return self.before or self.known

    def machine(self, setting: Setting, name: str) -> MachineSpec:
        """The machine as it fits best with the effect, else with the baseline, else as given, by tooth pairs as all
        effects need them; no effects."""
        if name in self.led:
            return moved(setting.plan.machine, setting.plan.numbers, self.led[name])
        return setting.fitted_machine or setting.plan.machine

    @property
    def views(self) -> tuple[Fitted, ...]:
        """Families, single lines, first and second sidebands one by one, the first two of these with phases; what there
        is of them, in this order."""
        return tuple(v for v in (self.fitted, self.fine, self.sides, self.twice, *self.phases) if v is not None)

    def view(self, name: str) -> Fitted:
        """The view that speaks for an effect."""
        return self.views[int(self.screen.by[self.screen.names.index(name)])]

    def levels_like(self, view: Fitted) -> Fitted:
        """The view of the same single lines without their phases, in which is judged what an effect leaves."""
        known = [k for k, one in enumerate(self.phases) if one is view]
        return next((v for v in ((self.fine, self.sides)[k] for k in known) if v is not None), view)

    def lines(self, name: str) -> Fitted:
        """The view of single lines (levels) that an effect is fitted in: own lines, unless sidebands speak for it."""
        view = self.view(name)
        if view is self.fitted and self.fine is not None:
            return self.fine
        return self.levels_like(view)
