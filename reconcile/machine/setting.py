"""What one reconciliation stands on, and what its candidates say."""

from __future__ import annotations

from dataclasses import dataclass

from reconcile.atlas.bank import Bank
from reconcile.atlas.plan import AtlasPlan
from reconcile.judge.changes import Changes, Lens
from reconcile.judge.screen import Fitted, Screen
from reconcile.machine.direct import NOTHING, Direct
from reconcile.machine.library import Catalogued
from reconcile.observe.observation import PointData
from sim.core.spec import MachineSpec


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
    fitted_machine: MachineSpec | None = None
    """The mean of the machines that agree with the baseline."""


@dataclass(frozen=True, kw_only=True)
class Found:
    """What the candidates say."""

    known: Catalogued
    fitted: Fitted
    screen: Screen
