"""What a simulation returns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from sim.core.spec import MachineSpec

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Channel:
    """A named output: `resonator1.y.acceleration`, `mesh1.stiffness`.

    `quantity` is `displacement`, `velocity`, `acceleration`, `angle`, `force`, `stiffness`, `state` ...;
    `location` the part (`bearing1`, `pinion`), `axis` `x`, `y`, `theta` or empty.
    """

    name: str
    quantity: str
    unit: str
    location: str
    axis: str = ""


@dataclass(frozen=True, kw_only=True)
class EnergyBalance:
    """Works and energies from t = 0 to the end, J: supplied = stored + dissipated up to `residual`.

    `limit` is the largest acceptable |residual| relative to `scale`; `acceptable` says whether it held.
    """

    work_j: Mapping[str, float]
    stored_j: Mapping[str, float]
    dissipated_j: Mapping[str, float]
    residual_j: float
    scale_j: float
    limit: float

    @property
    def relative_residual(self) -> float:
        """|residual| over the energy that went through the machine."""
        return abs(self.residual_j) / self.scale_j if self.scale_j > 0 else 0.0

    @property
    def acceptable(self) -> bool:
        """Whether the balance closes within its stated limit."""
        return self.relative_residual <= self.limit


@dataclass(frozen=True, kw_only=True)
class Quality:
    """How the numbers were made: step, refinement error, transient, energy."""

    step_s: float
    steps: int
    refined_steps: int
    """Steps shorter than the base step, taken around impacts."""
    unconverged_steps: int
    """Steps accepted at the finest level although the corrector had not met its tolerance."""
    step_error: float | None
    """Relative L2 difference against half the step on a pilot stretch, worst requested channel; None: not measured."""
    step_error_kind: str
    """`regular`, `irregular` (chaotic motion: compare statistics only) or `not measured`."""
    transient_end_s: float
    energy: EnergyBalance
    doubts: tuple[str, ...] = ()
    """Why the numbers are not to be trusted; empty when nothing speaks against them."""


@dataclass(frozen=True, kw_only=True)
class Response:
    """Signals at a uniform output rate with everything needed to judge them.

    `signals` has shape (channels, samples), float64, row i belongs to `channels[i]`;
    sample j is at t = j / sampling_rate_hz. `bases_hz` are the kinematic base frequencies
    (`f_r1`, `f_m`, `f_o1` ...); `derived` says for each mass, inertia and stiffness whether it was given or derived.
    """

    machine: MachineSpec
    sampling_rate_hz: float
    channels: tuple[Channel, ...]
    signals: FloatArray
    bases_hz: Mapping[str, float]
    derived: Mapping[str, str]
    quality: Quality
    warnings: tuple[str, ...]
    contact_share: Mapping[str, float]
    """Share of the simulated time each wall or mesh was in contact, by element."""
    seed: int
    version: str
    speed: FloatArray = field(default_factory=lambda: np.zeros(4))
    """Table of the speed over time (`sim.core.speed`); `bases_hz` hold at its mean over the run."""

    def signal(self, name: str) -> FloatArray:
        """Samples of one channel, shape (samples,); KeyError names what exists."""
        for row, channel in enumerate(self.channels):
            if channel.name == name:
                values: FloatArray = self.signals[row]
                return values
        raise KeyError(f"no channel {name!r}; present: {', '.join(c.name for c in self.channels)}")
