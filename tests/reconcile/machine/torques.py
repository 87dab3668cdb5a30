"""What the size of a torque is told on: a torque that is seen, and healthy machines that may have it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from reconcile.atlas.places import standard_channels
from reconcile.atlas.plan import atlas_plan
from reconcile.calibrate.uncertain import uncertain_numbers
from reconcile.machine.many_turns import ManyTurns
from reconcile.machine.ripple import MACHINES
from sim.core.spec import MachineSpec

FOUR = ManyTurns(shaft="input", turns=4, order=4.0, rise_db=9.0, elsewhere_db=0.0, speeds=(3, 3))


def few(machine: MachineSpec, data: Any, pairs: int = MACHINES, **more: Any) -> Any:
    """A setting of healthy draws alone."""
    plan = atlas_plan(machine, uncertain_numbers(machine), (), seed=3, draws=1, pairs=pairs)
    both = standard_channels(machine, ())[2::-2]
    assert both != tuple(sorted(both)), "not in the order in which channels are simulated"
    usual = {"machine": machine, "data": data, "simulated": both, "plan": plan, "seed": 1, "fitted_machine": None}
    return SimpleNamespace(**{**usual, **more})
