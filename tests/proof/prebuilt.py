"""The small atlas that stands beside the small cases."""

from __future__ import annotations

from pathlib import Path

from sim.core.spec import MachineSpec
from tests.proof.small import NOMINATED, SENSORS, SPEED_HZ
from tests.reconcile import prebuilt
from tests.reconcile.prebuilt import Wanted

BANK = Path(__file__).parent / "atlas" / "30hz.npz"


def wanted(machine: MachineSpec) -> Wanted:
    """What the engine asks for in every small case."""
    return prebuilt.wanted(machine, NOMINATED, SENSORS, SPEED_HZ, BANK)
