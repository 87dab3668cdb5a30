"""Statistics to features: decibels that saturate at the noise, so that what is buried changes nothing.

A simulated machine's statistics pass the calibrated chain first; the noise they would have gathered is added as its
expectation. Features of recordings and of simulations are then the same quantities.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reconcile.calibrate.chain import Chain
from reconcile.observe.phases import between_sensors, wrapped
from reconcile.observe.statistics import LOBE, SHAPE_BANDS_HZ, third_octaves
from signals.series import FloatArray

SOFT = 2.0
"""A line's level counts from this many times its noise."""
SHAPE_DB = 6.0
"""Scale of the moments, so that doubling a large one counts like a few decibels."""
LEAST_DEPTH = 1e-5


@dataclass(frozen=True, kw_only=True)
class Layout:
    """Sizes of the parts of a feature vector of one channel, in this order."""

    lines: int
    bands: int
    shapes: int
    modulations: int
    shafts: int = 0
    phases: int = 0

    @property
    def size(self) -> int:
        """Features a channel."""
        return self.lines + 2 * self.bands + self.shapes * (self.modulations + self.shafts + 2) + self.phases

    def slices(self) -> dict[str, slice]:
        """`line`, `floor`, `total`, `depth`, `turn`, `kurtosis`, `skewness`, `phase`."""
        sizes = {
            "line": self.lines,
            "floor": self.bands,
            "total": self.bands,
            "depth": self.shapes * self.modulations,
            "turn": self.shapes * self.shafts,
            "kurtosis": self.shapes,
            "skewness": self.shapes,
            "phase": self.phases,
        }
        start, found = 0, {}
        for name, size in sizes.items():
            found[name] = slice(start, start + size)
            start += size
        return found


@dataclass(frozen=True, kw_only=True)
class Scale:
    """What the soft decibels lean on at one point: noise of lines (C, L) and of mean turns (C, E, S), depths (E,)."""

    line_noise: FloatArray
    depth_noise: FloatArray
    turn_noise: FloatArray


def scale_of(chain: Chain, lines_hz: FloatArray, resolution_hz: float, turns: FloatArray) -> Scale:
    """Reference levels from the noise the chain adds; `turns` (S,) of each shaft in half a record."""
    widths = np.array([high - low for low, high in SHAPE_BANDS_HZ])
    return Scale(
        line_noise=chain.line_noise(lines_hz) * LOBE * resolution_hz,
        depth_noise=2.0 * LOBE * resolution_hz / widths + LEAST_DEPTH,
        turn_noise=chain.shape_noise()[:, :, None] / np.maximum(turns, 1.0),
    )


def soft_features(
    line: FloatArray,
    floor: FloatArray,
    total: FloatArray,
    depth: FloatArray,
    turn: FloatArray,
    kurtosis: FloatArray,
    skewness: FloatArray,
    phase: FloatArray,
    scale: Scale,
) -> FloatArray:
    """Features (..., C, F) of statistics with any leading axes; NaN where nothing was measured."""
    tiny = 1e-300
    parts = [
        10.0 * np.log10(line + SOFT * scale.line_noise + tiny),
        10.0 * np.log10(floor + tiny),
        10.0 * np.log10(total + tiny),
    ]
    deep = 10.0 * np.log10(depth + SOFT * scale.depth_noise[:, None])
    parts.append(deep.reshape(*deep.shape[:-2], -1))
    local = 10.0 * np.log10(turn + SOFT * scale.turn_noise)
    parts.append(local.reshape(*local.shape[:-2], -1))
    parts.append(SHAPE_DB * np.arcsinh(kurtosis))
    parts.append(SHAPE_DB * np.arcsinh(2.0 * skewness))
    parts.append(between_sensors(phase))
    return np.concatenate(parts, axis=-1)


def changed(after: FloatArray, before: FloatArray, phases: int) -> FloatArray:
    """Difference of features (..., F), of which the last `phases` are known up to whole turns."""
    found = np.array(after - before)
    if phases:
        found[..., -phases:] = wrapped(found[..., -phases:])
    return found


@dataclass(frozen=True, kw_only=True)
class Passed:
    """Statistics of simulated machines as the sensors would see them, leading axis N."""

    line: FloatArray
    floor: FloatArray
    total: FloatArray
    depth: FloatArray
    turn: FloatArray
    kurtosis: FloatArray
    skewness: FloatArray
    phase: FloatArray

    def features(self, scale: Scale) -> FloatArray:
        """(N, C, F)."""
        return soft_features(
            self.line,
            self.floor,
            self.total,
            self.depth,
            self.turn,
            self.kurtosis,
            self.skewness,
            self.phase,
            scale,
        )


def through(
    chain: Chain, bank: object, lines_hz: FloatArray, resolution_hz: float, louder: FloatArray | float = 1.0
) -> Passed:
    """The bank's statistics behind the chain; `louder`, (N, C) or a number, multiplies the noise."""
    more = np.asarray(louder, dtype=np.float64)
    more = more[..., None] if more.ndim else more
    widths = np.diff(third_octaves())
    shape_widths = np.array([high - low for low, high in SHAPE_BANDS_HZ])
    gain = 10.0 ** (chain.gain_db / 10.0)
    noise = chain.noise * more
    lobe = LOBE * resolution_hz
    line = chain.line_gain(lines_hz) * bank.line + chain.line_noise(lines_hz) * more * lobe  # type: ignore[attr-defined]
    signal = chain.shape_gain() * bank.band  # type: ignore[attr-defined]
    share = signal / (signal + chain.shape_noise() * more + 1e-300)
    depth_noise = (1.0 - share**2) * 2.0 * lobe / shape_widths
    return Passed(
        line=line,
        floor=gain * bank.floor + noise,  # type: ignore[attr-defined]
        total=gain * bank.total + noise * widths,  # type: ignore[attr-defined]
        turn=chain.shape_gain()[..., None] * bank.turn,  # type: ignore[attr-defined]
        depth=bank.depth * share[..., None] ** 2 + depth_noise[..., None],  # type: ignore[attr-defined]
        kurtosis=bank.kurtosis * share**2,  # type: ignore[attr-defined]
        skewness=bank.skewness * share**1.5,  # type: ignore[attr-defined]
        phase=bank.phase,  # type: ignore[attr-defined]
    )
