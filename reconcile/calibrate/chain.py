"""The path from the machine's motion to the recorded samples: a smooth gain and a noise floor for every sensor.

Only magnitudes matter to the features. The gain is read where a healthy recording's lines stand out of its floor,
against the healthy machines of the atlas, and is smooth over frequency: sensor mounts and casings have few modes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reconcile.observe.statistics import LOBE, SHAPE_BANDS_HZ, Statistics, third_octaves
from signals.series import FloatArray

STANDS_OUT = 25.0
"""A line this many times its floor tells about the gain."""
LEADING = 0.03
"""Weaker lines tell little: in the model they may be rounding, in the recording a neighbour's leakage."""
FARTHEST_DB = 20.0
"""The gain stays within this of its median: what a mount's resonance can do."""
SMOOTH_OCTAVES = 0.4
"""Width of the smoothing kernel: a sensor mount's resonance is about that wide."""
PRIOR_DB = 12.0
"""How far the gain may leave its mean where nothing is seen."""
LEAST_NOISE = 1e-9
"""Smallest noise relative to the signal: keeps logarithms finite for recordings without any."""


@dataclass(frozen=True, kw_only=True)
class Healthy:
    """What the nominal machine shows: logarithmic means over healthy draws and their spread, (C, L) and (C, B)."""

    line: FloatArray
    line_spread_db: FloatArray
    floor: FloatArray


@dataclass(frozen=True, kw_only=True)
class Chain:
    """`gain_db` (C, B) at the third octaves; `noise` (C, B) density in the recording's unit^2/Hz at one point."""

    gain_db: FloatArray
    noise: FloatArray

    def line_gain(self, lines_hz: FloatArray) -> FloatArray:
        """Power gain at the lines, (C, L)."""
        return np.asarray(10.0 ** (_at(lines_hz, self.gain_db) / 10.0))

    def line_noise(self, lines_hz: FloatArray) -> FloatArray:
        """Noise density at the lines, (C, L)."""
        return np.asarray(np.exp(_at(lines_hz, np.log(self.noise))))

    def shape_gain(self) -> FloatArray:
        """Power gain in the shape bands, (C, E): the mean over the band."""
        return np.asarray(10.0 ** (_over_bands(self.gain_db) / 10.0))

    def shape_noise(self) -> FloatArray:
        """Noise power in the shape bands, (C, E)."""
        widths = np.array([high - low for low, high in SHAPE_BANDS_HZ])
        return np.asarray(np.exp(_over_bands(np.log(self.noise))) * widths)


def band_centres_hz() -> FloatArray:
    """Geometric centres of the third octaves, Hz."""
    edges = third_octaves()
    return np.asarray(np.sqrt(edges[1:] * edges[:-1]))


def _at(lines_hz: FloatArray, bands: FloatArray) -> FloatArray:
    """Band values (C, B) interpolated over log frequency at the lines, (C, L)."""
    x, grid = np.log(np.maximum(lines_hz, 1e-3)), np.log(band_centres_hz())
    return np.stack([np.interp(x, grid, row) for row in bands])


def _over_bands(bands: FloatArray) -> FloatArray:
    centres = band_centres_hz()
    masks = [(centres >= low) & (centres < high) for low, high in SHAPE_BANDS_HZ]
    return np.stack([bands[:, m].mean(axis=1) for m in masks], axis=1)


def _filled(bands: FloatArray) -> FloatArray:
    """NaN bands take the nearest band's value; a row without any becomes the smallest positive number."""
    filled = bands.copy()
    for row in filled:
        good = np.isfinite(row) & (row > 0)
        if good.any():
            place = np.arange(row.size)
            row[:] = np.exp(np.interp(place, place[good], np.log(row[good])))
        else:
            row[:] = np.finfo(float).tiny
    return filled


def floor_at(seen: Statistics, lines_hz: FloatArray) -> FloatArray:
    """Density of a recording's own floor at the lines, (C, L), unit^2/Hz."""
    return np.asarray(np.exp(_at(lines_hz, np.log(_filled(seen.floor)))))


def leading(power: FloatArray, hz: FloatArray) -> np.ndarray:
    """Lines that are no weaker than `LEADING` of the strongest within half an octave either way, (L,)."""
    octaves = np.log2(np.maximum(hz, 1e-3))
    near = np.abs(octaves[:, None] - octaves[None, :]) <= 0.5
    known = np.nan_to_num(power)
    return np.asarray((known > 0) & (known >= LEADING * np.where(near, known[None, :], 0.0).max(axis=1)))


def _smooth_gain(hz: FloatArray, ratio_db: FloatArray, weight: FloatArray) -> FloatArray:
    """Kernel smooth of one channel's ratios at the band centres, pulled to their median where little is seen."""
    good = np.isfinite(ratio_db) & (weight > 0)
    centres = np.log2(band_centres_hz())
    if not good.any():
        return np.zeros(centres.size)
    median = float(np.median(ratio_db[good]))
    distance = (centres[:, None] - np.log2(hz[good])[None, :]) / SMOOTH_OCTAVES
    kernel = np.exp(-0.5 * distance**2) * weight[good]
    pull = 1.0 / PRIOR_DB**2
    offset = kernel @ (ratio_db[good] - median) / (kernel.sum(axis=1) + pull)
    return np.asarray(median + np.clip(offset, -FARTHEST_DB, FARTHEST_DB))


def calibrate_chain(
    recorded: list[Statistics], healthy: list[Healthy], lines_hz: list[FloatArray]
) -> tuple[Chain, ...]:
    """One chain a point; the gain is common to all points, the noise each point's own."""
    channels = recorded[0].floor.shape[0]
    gain = np.zeros((channels, band_centres_hz().size))
    for c in range(channels):
        ratios, weights, places = [], [], []
        for seen, model, hz in zip(recorded, healthy, lines_hz, strict=True):
            noise = np.interp(np.log(hz), np.log(band_centres_hz()), _filled(seen.floor)[c]) * LOBE * seen.resolution_hz
            power = seen.line[c]
            out = (power > STANDS_OUT * noise) & leading(power, hz) & leading(model.line[c], hz)
            with np.errstate(invalid="ignore", divide="ignore"):
                ratio = 10.0 * np.log10((power - noise) / model.line[c])
            ratios.append(np.where(out, ratio, np.nan))
            weights.append(1.0 / (2.0 + model.line_spread_db[c] ** 2))
            places.append(hz)
        gain[c] = _smooth_gain(np.concatenate(places), np.concatenate(ratios), np.concatenate(weights))
    chains = []
    for seen, model in zip(recorded, healthy, strict=True):
        floor = _filled(seen.floor)
        own = 10.0 ** (gain / 10.0) * np.nan_to_num(model.floor)
        total = _filled(seen.total)
        chains.append(Chain(gain_db=gain, noise=np.maximum(floor - own, np.maximum(0.05 * floor, LEAST_NOISE * total))))
    return tuple(chains)
