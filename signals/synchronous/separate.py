"""Regular, residual and difference signal of a gear's mean turn.

Regular: the shaft's first orders and all harmonics of the meshes, with their first sidebands. Residual: the mean turn
without shaft orders and mesh harmonics. Difference: the residual without the first sidebands as well. Authors use the
names differently; these are the definitions of M. Lebold, K. McClintic, R. Campbell, C. Byington and K. Maynard,
"Review of vibration analysis methods for gearbox diagnostics and prognostics", Proc. 54th Meeting of the Society for
Machinery Failure Prevention Technology, 2000, 623-634. The difference signal is that of R. M. Stewart, "Some useful
data analysis techniques for gearbox diagnostics", Proc. Meeting on the Applications of Time Series Analysis, ISVR,
Southampton, 1977.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft

from signals.series import BoolArray, FloatArray
from signals.synchronous.average import SynchronousAverage
from sim.core.errors import Problem, SpecError

SHAFT_ORDERS = 2
SIDEBANDS = 1


@dataclass(frozen=True, kw_only=True)
class GearSignals:
    """Parts of a mean turn, each of shape (samples_per_revolution,), in the unit of `average`."""

    average: SynchronousAverage
    teeth: tuple[int, ...]
    shaft_orders: int
    sidebands: int
    regular: FloatArray
    residual: FloatArray
    difference: FloatArray


def separate(
    average: SynchronousAverage,
    *,
    teeth: Sequence[int],
    shaft_orders: int = SHAFT_ORDERS,
    sidebands: int = SIDEBANDS,
) -> GearSignals:
    """Split a mean turn. `teeth`: of each gear on this shaft; the mean and orders up to `shaft_orders` are regular."""
    m = average.samples_per_revolution
    problems = [
        Problem(
            field=f"teeth[{i}]",
            message="must leave a mesh harmonic and its sidebands below half the samples of a turn",
            given=z,
            allowed=f"{sidebands + 1} to {m // 2 - sidebands - 1}",
        )
        for i, z in enumerate(teeth)
        if not sidebands < z < m // 2 - sidebands
    ]
    if not teeth:
        problems.append(Problem(field="teeth", message="needs the teeth of at least one gear", given=list(teeth)))
    if shaft_orders < 0 or sidebands < 0:
        given = (shaft_orders, sidebands)
        problems.append(Problem(field="shaft_orders/sidebands", message="must not be negative", given=given))
    if problems:
        raise SpecError(problems)
    transform = fft.rfft(average.samples)
    mesh = _orders(transform.size, teeth, 0)
    mesh[: shaft_orders + 1] = True
    with_sidebands = mesh | _orders(transform.size, teeth, sidebands)
    residual = fft.irfft(np.where(mesh, 0.0, transform), n=m)
    difference = fft.irfft(np.where(with_sidebands, 0.0, transform), n=m)
    return GearSignals(
        average=average,
        teeth=tuple(int(z) for z in teeth),
        shaft_orders=shaft_orders,
        sidebands=sidebands,
        regular=np.asarray(average.samples - difference, dtype=np.float64),
        residual=np.asarray(residual, dtype=np.float64),
        difference=np.asarray(difference, dtype=np.float64),
    )


def _orders(size: int, teeth: Sequence[int], reach: int) -> BoolArray:
    """Orders within `reach` of a harmonic of a mesh, shape (size,)."""
    order = np.arange(size)
    near = np.zeros(size, dtype=np.bool_)
    for z in teeth:
        harmonic = np.maximum(np.rint(order / z), 1) * z
        near |= np.abs(order - harmonic) <= reach
    return near
