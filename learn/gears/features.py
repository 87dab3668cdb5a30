"""Features of a gear: does one place of its turn stand out, by how much, and do channels and bands agree on it.

In each channel and band the mesh harmonics are removed with their low sidebands, which sound gears have of every
height (run-out, an uneven torque); what is left of the mean turn is looked at through a window of a tooth's width. The
product of two halves of the turns (`learn.gears.turns`) gives its local power without that of noise. A damaged tooth
makes one peak, errors of all teeth make many (R. M. Stewart's FM4 asks the same of the whole band; Proc. ISVR,
Southampton, 1977). No unit, no gain enters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft

from learn.gears.turns import FEWEST_TURNS, Turns, first_half
from signals.series import BoolArray, ComplexArray, FloatArray

SIDEBANDS = 4
"""Pairs of sidebands that are removed with a mesh harmonic."""
WINDOW_TEETH = 1.5
APART_TEETH = 2.5
"""A second peak is looked for this far from the first."""
FLOOR_SHARE = 0.5
"""Of a half's noise power, added to both sides of a ratio: without it nothing over nothing would be a peak."""
LEAST_DEPTH = 1e-4
BANDS = ("first", "second", "third", "high", "all", "flat", "envelope")
NAMES = (
    "peak",
    "alone",
    "kurtosis",
    "locked",
    "depth",
    "envelope",
    "most_alone",
    "most_kurtosis",
    "middle_peak",
    "middle_kurtosis",
    "agree",
    "mate_peak",
    "mate_alone",
    "turns",
    "teeth",
    *(f"{what}_{band}" for what in ("alone", "kurtosis", "locked", "mate_alone") for band in BANDS),
)


@dataclass(frozen=True, kw_only=True)
class Place:
    """One channel and band of a gear. `peak`, `alone`, `kurtosis`: logarithms of the largest local power over the mean,
    over the second largest, and of the local power's second moment; `locked`, `depth`: log10 of locked power over
    noise, of the peak's amplitude over the mesh's; `at`: share of the turn."""

    channel: int
    band: str
    peak: float
    alone: float
    kurtosis: float
    locked: float
    depth: float
    at: float


def kept(size: int, teeth: int, sidebands: int = SIDEBANDS) -> BoolArray:
    """Orders of a turn that are neither the shaft's lowest nor near a mesh harmonic, (size,)."""
    reach = min(sidebands, max(1, (teeth - 4) // 4))
    order = np.arange(size)
    away = np.abs(order - np.rint(order / teeth) * teeth)
    return np.asarray((away > reach) & (order > sidebands), dtype=np.bool_)


def band_edges(size: int, teeth: int) -> dict[str, tuple[float, float]]:
    """Orders of the bands: about the first three mesh harmonics, above, all."""
    z, top = float(teeth), float(size - 1)
    edges = {
        "first": (0.5 * z, 1.5 * z),
        "second": (1.5 * z, 2.5 * z),
        "third": (2.5 * z, 4.5 * z),
        "high": (4.5 * z, top),
        "all": (0.5 * z, top),
        "flat": (0.5 * z, top),
    }
    return {name: (low, min(high, top)) for name, (low, high) in edges.items() if low < 0.9 * top}


def flattened(spectrum: ComplexArray, teeth: int) -> ComplexArray:
    """Spectrum of a turn with the mean power of each two mesh orders' width put to one: no resonance outweighs."""
    power = np.abs(spectrum) ** 2
    width = max(5, 2 * teeth)
    kernel = np.ones(min(width, power.size))
    local = np.convolve(power, kernel, mode="same") / np.convolve(np.ones(power.size), kernel, mode="same")
    return np.asarray(spectrum / np.sqrt(np.maximum(local, 1e-12 * np.max(local) + 1e-300)), dtype=np.complex128)


def places(turns: Turns, channel: int) -> list[Place]:
    """All bands of one channel."""
    n, z = turns.samples.shape[1], turns.teeth
    first, second = (np.asarray(fft.rfft(h), dtype=np.complex128) for h in turns.halves())
    keep = kept(first.size, z)
    mesh = np.abs((first + second) / 2)[z::z]
    carrier = float(np.sqrt(2 * np.sum(mesh**2))) / n
    each = fft.rfft(turns.samples, axis=1)
    noise = np.sum(np.abs(each - np.mean(each, axis=0)) ** 2, axis=0) / max(turns.count - 1, 1) / (turns.count / 2)
    found = []
    order = np.arange(first.size)
    for name, (low, high) in band_edges(first.size, z).items():
        inside = keep & (order >= low) & (order <= high)
        if np.sum(inside) < 4:
            continue
        a, b, spread = np.where(inside, first, 0), np.where(inside, second, 0), np.where(inside, noise, 0.0)
        if name == "flat":
            gain = _gain(first, second, inside, z)
            a, b, spread = a * gain, b * gain, spread * gain**2
        rows = (fft.irfft(a, n), fft.irfft(b, n))
        found.append(_place(rows, float(2 * np.sum(spread)) / n**2, z, channel, name, carrier))
    found.append(_of_envelope(each, keep & (order >= 0.5 * z), n, z, turns.mate, channel))
    return found


def _gain(first: ComplexArray, second: ComplexArray, inside: BoolArray, teeth: int) -> FloatArray:
    """What flattens both halves alike, (orders,)."""
    both = np.where(inside, (first + second) / 2, 0)
    flat = flattened(np.asarray(both), teeth)
    return np.asarray(np.abs(flat) / np.maximum(np.abs(both), 1e-300), dtype=np.float64)


def _of_envelope(each: ComplexArray, inside: BoolArray, n: int, teeth: int, mate: int, channel: int) -> Place:
    """The same of the squared envelope, which needs no phase that is locked from turn to turn."""
    half = np.zeros((each.shape[0], n), dtype=np.complex128)
    half[:, : inside.size] = np.where(inside, each, 0)
    square = np.abs(fft.ifft(half, axis=1)) ** 2
    square /= max(float(np.mean(square)), 1e-300)
    lines = fft.rfft(square, axis=1)
    lines[:, : SIDEBANDS + 1] = 0
    lines[:, 2 * teeth :] = 0
    turned = fft.irfft(lines, n, axis=1)
    scatter = float(np.mean(np.var(turned, axis=0, ddof=1))) / (each.shape[0] / 2)
    first = first_half(each.shape[0], teeth, mate)
    halves = np.mean(turned[first], axis=0), np.mean(turned[~first], axis=0)
    return _place(halves, scatter, teeth, channel, "envelope", 1.0)


def _place(
    rows: tuple[FloatArray, FloatArray], noise: float, teeth: int, channel: int, band: str, carrier: float
) -> Place:
    """Local locked power of two halves, and its largest places. `noise`: power of a half's noise."""
    n = rows[0].size
    local = _smoothed(rows[0] * rows[1], WINDOW_TEETH / teeth)
    floor = FLOOR_SHARE * noise + 1e-12 * float(np.mean(rows[0] ** 2)) + 1e-300
    mean, k = max(float(np.mean(local)), 0.0), int(np.argmax(local))
    far = np.abs((np.arange(n) - k + n // 2) % n - n // 2) > APART_TEETH / teeth * n
    top, other = max(float(local[k]), 0.0), float(np.max(local[far], initial=0.0))
    clear = np.maximum(local, 0.0)
    return Place(
        channel=channel,
        band=band,
        peak=float(np.log((top + floor) / (mean + floor))),
        alone=float(np.log((top + floor) / (other + floor))),
        kurtosis=float(np.log((np.mean(clear**2) + floor**2) / (mean + floor) ** 2)),
        locked=float(np.log10(mean / max(noise, 1e-300) + 1e-2)),
        depth=float(np.log10(np.sqrt(top) / max(carrier, 1e-300) + LEAST_DEPTH)),
        at=k / n,
    )


def _smoothed(values: FloatArray, share: float) -> FloatArray:
    """Mean through a window of a share of the turn, Hann, around the turn."""
    n = values.size
    width = max(3, 2 * round(share * n))
    window = np.zeros(n)
    window[: min(width, n)] = np.hanning(min(width, n) + 2)[1:-1]
    window = np.roll(window / np.sum(window), -(min(width, n) // 2))
    return np.asarray(fft.irfft(fft.rfft(values) * fft.rfft(window), n), dtype=np.float64)


@dataclass(frozen=True, kw_only=True)
class Gear:
    """What all channels and bands show of a gear; `best` is where its peak is highest. None: too few turns."""

    teeth: int
    turns: int
    all: tuple[Place, ...]
    best: Place | None

    def most(self, what: str, least: float = 0.0) -> list[float]:
        """The largest of one number over the channels, band by band."""
        return [max((getattr(p, what) for p in self.all if p.band == band), default=least) for band in BANDS]


def gear(turns: Sequence[Turns]) -> Gear:
    """A gear, its turns channel by channel."""
    z, count = turns[0].teeth, turns[0].count
    if count < FEWEST_TURNS:
        return Gear(teeth=z, turns=count, all=(), best=None)
    found = tuple(place for c, one in enumerate(turns) for place in places(one, c))
    return Gear(teeth=z, turns=count, all=found, best=max(found, key=lambda p: p.peak + p.alone))


def row(one: Gear, mate: Gear) -> FloatArray:
    """Features of a gear in the order of `NAMES`."""
    best = one.best
    other = (mate.best.peak, mate.best.alone) if mate.best is not None else (0.0, 0.0)
    bands = [*one.most("alone"), *one.most("kurtosis"), *one.most("locked", -2.0), *mate.most("alone")]
    if best is None:
        return np.array([0.0] * 3 + [-2.0, -4.0] + [0.0] * 6 + [*other, 0.0, np.log(one.teeth), *bands])
    peaks, curved = [p.peak for p in one.all], [p.kurtosis for p in one.all]
    near = [abs((p.at - best.at + 0.5) % 1 - 0.5) * one.teeth <= WINDOW_TEETH for p in one.all]
    return np.array(
        [
            best.peak,
            best.alone,
            best.kurtosis,
            best.locked,
            best.depth,
            max((p.peak + p.alone for p in one.all if p.band == "envelope"), default=0.0),
            max(p.alone for p in one.all),
            max(curved),
            float(np.median(peaks)),
            float(np.median(curved)),
            float(np.mean(near)),
            *other,
            np.log(one.turns),
            np.log(one.teeth),
            *bands,
        ]
    )


def vector(gears: tuple[Gear, Gear]) -> tuple[FloatArray, int]:
    """(features of the stage: those of the gear of which one place stands out more, which of the two that is)."""
    which = int(np.argmax([sum(g.most("alone")) if g.best is not None else -1.0 for g in gears]))
    return row(gears[which], gears[1 - which]), which
