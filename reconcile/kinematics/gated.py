"""The sensor gate as the level of kinematics asks it."""

from __future__ import annotations

from collections.abc import Sequence

from reconcile.gate import Gate, inspect_measurement
from reconcile.kinematics.families import Ties
from reconcile.kinematics.unheard import with_unheard
from signals.recording import Recording


def gated(tests: Sequence[Recording], baselines: Sequence[Recording], tie: Ties, seed: int) -> Gate:
    """What is wrong with the recordings as measurements, and the recordings put right."""
    gate = inspect_measurement(
        baselines,
        tests,
        orders=tuple(f.order for f in tie.families if f.kind != "turn"),
        mesh_orders=tie.mesh_orders,
        shaft_orders=tuple(tie.shafts.values()),
        lowest_order=tie.lowest_order,
        seed=seed,
    )
    return with_unheard(gate)
