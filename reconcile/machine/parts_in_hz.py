"""Lines of a machine's bearings at a frequency in Hz, to be told from what keeps its own time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.kinematics.families import Family, ties
from reconcile.kinematics.spec import of_machine
from reconcile.observe.observation import PointData
from signals.series import FloatArray
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec

OWN_HZ = 1.0
"""Distance from an order of a part below which a frequency may be that order's."""
MULTIPLES = 4
"""Of what a bearing's part modulates with: at two speeds its third and its second may meet, at 2:3."""


def parts_of(machine: MachineSpec) -> tuple[Family, ...]:
    """What bearings modulate with; none where shafts are not tied."""
    try:
        return ties(of_machine(machine), machine.operating.shaft if machine.operating else None).families
    except SpecError:
        return ()


def of_a_part(data: Sequence[PointData], families: Sequence[Family], hz: float) -> bool:
    """Whether one part's low multiples, within its slip, meet the frequency at every speed."""
    turning = [f for f in families if f.slip > 0.0]
    return any(all(_met(f, d.spectra[0].speed_hz, hz) for d in data) for f in turning)


def of_parts(data: Sequence[PointData], families: Sequence[Family], hz: float) -> bool:
    """Whether at every speed some part's do: both races' lines meet at 100 Hz at 22.5 and 39 Hz of the paper's."""
    turning = [f for f in families if f.slip > 0.0]
    return all(any(_met(f, d.spectra[0].speed_hz, hz) for f in turning) for d in data)


def beside_a_part(
    one: PointData, families: Sequence[Family], hz: float, grid: FloatArray, risen: FloatArray, least_db: float
) -> bool:
    """Whether it is a sideband, by its shaft or cage, of a part's line that has `risen` (grid,) by so much itself."""
    speed_hz = one.spectra[0].speed_hz
    for family in (f for f in families if f.slip > 0.0):
        for order in (k * family.order for k in range(1, MULTIPLES + 1)):
            slip = OWN_HZ + family.slip * order * speed_hz
            beside = min(abs(hz - (order + side * family.spacing) * speed_hz) for side in (-1.0, 1.0))
            middle = np.abs(grid - order * speed_hz) <= slip
            if beside <= slip and float(risen[middle].max(initial=0.0)) >= least_db:
                return True
    return False


def _met(family: Family, speed_hz: float, hz: float) -> bool:
    own = [k * family.order * speed_hz for k in range(1, MULTIPLES + 1)]
    return any(abs(hz - at) <= OWN_HZ + family.slip * at for at in own)
