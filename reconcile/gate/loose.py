"""A loose sensor: its transfer changed by a smooth function of frequency, lines and noise alike, at every speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import reduce

import numpy as np
from scipy import fft

from reconcile.gate.findings import Finding
from reconcile.gate.levels import Pair
from signals.recording import Recording
from signals.series import BoolArray, FloatArray

QUIET_DB = 1.0
LOOSE_DB = 6.0
LOOSE_BAND_DB = 3.0
LOOSE_ROUGH_DB = 2.0
ROUGH_SHARE = 0.2
"""By which lines, floor and speeds may differ in their change, at least or as a share of the change."""
LOOSE_IMPACTS = 0.5
"""Growth of the kurtosis of the bands that changed: a filter makes no impacts."""
CREST_DB = 4.0
"""Growth of the mean over the quiet moments, a quarter of the wide bands above, that weighs as a kurtosis of one does
(impacts too dense for narrow bands to part them)."""
QUIET_SHARE = 0.2
MOST_DB = 4.5
"""The most by which speeds may differ, and other channels have changed, however far the sensor's band did: a bearing
that no longer rattles falls silent by 40 dB, and its neighbour changes by 6."""
NARROW_BANDS = 3
FLOOR_KEEPS, FLOOR_MOST = 0.4, 1.1
"""Of the change of a band's power the least that its noise shows where few bands changed: a narrow peak fills a band
partly; and the most: what raises the noise more than the lines is none of the sensor's."""
LEVEL_DB, LEAST_SPEEDS = 3.0, 3
"""By how much a whole record may be louder than its baseline, and at how many speeds a narrow peak must be alike."""
OTHERS_SHARE = 0.3
"""By which, of its change, other channels may have changed for it to be remarked; a fault needs them quiet."""
ELSEWHERE_SHARE = 0.6
"""Of a rise, by which another channel may have risen in bands of its own: noise of the machine raises each sensor in
the bands that its place amplifies (a fall is no noise that was added). Friction noise that both sensors of made motors
hear has 0.76 to 0.93, single loose sensors on 14 of the proof's gearboxes 0.42 at most, beside another sensor's fault
0.67 and more (dropouts, an alias, a second loose one)."""
BELOW, LEAST_LINES = 3.0, 2
"""A loose mount raises nothing below a third of its resonance by more than 1 dB, noise that is added does; strong
lines that must say so."""
ADDED_DB, STAYED = 2.5, 0.5
"""By which the noise under strong lines there rose (their median), and the share of it that the lines then rise by at
most: friction noise of made motors raised it by 3.1 to 13 dB and the lines by less than 0.1, loose sensors (made, of
the proof's gearboxes) by 0.9 dB at most."""


def loose_findings(pairs: Sequence[Pair], change: Sequence[FloatArray], c: int, name: str) -> list[Finding]:
    """A filter on one channel: bands changed, lines as the floor, alike at all speeds, no impacts, others quiet."""
    shared = reduce(np.intersect1d, [p.band for p in pairs])
    if not shared.size:
        return []
    places = [np.searchsorted(p.band, shared) for p in pairs]
    levels = [_level(d, c) for d in change]
    sized = [d[:, :, at] - level for d, at, level in zip(change, places, levels, strict=True)]
    own = np.stack([d[c] for d in sized])
    curve = np.mean(own, axis=(0, 1))
    changed = np.abs(curve) > LOOSE_BAND_DB
    size = float(np.max(np.abs(curve)))
    if size < LOOSE_DB or not np.any(changed):
        return []
    rough = _rough(own, curve, changed)
    grown = [float(np.median(p.impacts[c, at][changed])) for p, at in zip(pairs, places, strict=True)]
    impacts = float(np.median(grown)) if len(grown) >= LEAST_SPEEDS else max(grown)  # those of a defect come at all
    crests = [float(np.percentile(p.crest_change[c], 75)) / CREST_DB for p in pairs if p.crest_change.size]
    impacts = max([impacts, *crests])  # records of a fraction of a second have none
    rest = [k for k in range(len(pairs[0].names)) if k != c]
    others = [d[k, 0][changed] for d in sized for k in rest]
    loudest = max(float(np.median(np.abs(o))) for o in others)
    if rough > _allowed(LOOSE_ROUGH_DB, ROUGH_SHARE, size) or impacts > LOOSE_IMPACTS or loudest > OTHERS_SHARE * size:
        return []
    top = int(np.argmax(np.abs(curve)))
    centre_hz = pairs[0].centre_hz[places[0]]
    hz = float(centre_hz[top])
    risen = curve[top] > 0 and _elsewhere(sized, c) > max(LOOSE_DB, ELSEWHERE_SHARE * size)
    if risen or _only_noise(pairs, c, hz):
        return []
    detail = f"its transfer changed by up to {curve[top]:+.0f} dB around {hz:.4g} Hz, lines and noise alike; "
    quiet = loudest <= _allowed(2 * QUIET_DB, QUIET_SHARE, size)
    detail += f"the other channels changed by {loudest:.1f} dB there"
    return [
        Finding(
            kind="loose_sensor",
            channel=name,
            recording="all tests",
            detail=detail,
            severity=float(min(1.0, size / 20)),
            fault=quiet,
            transfer_db=tuple(zip(map(float, centre_hz), map(float, curve), strict=True)),
        )
    ]


def _elsewhere(change: Sequence[FloatArray], c: int) -> float:
    """The most, dB, that another channel than `c` rose by in any band, at all speeds; `change`: of each pair
    (channels, 2, bands)."""
    mean = np.mean(np.stack(change), axis=(0, 2))
    return float(np.max(np.delete(mean, c, axis=0), initial=0.0))


def _only_noise(pairs: Sequence[Pair], c: int, hz: float) -> bool:
    """Whether far below a resonance at `hz` the noise rose and the lines in it did not."""
    low = [(one := p.lines[c], one.hz < hz / BELOW) for p in pairs]
    lines = np.concatenate([one.change_db[below] for one, below in low])
    if lines.size < LEAST_LINES:
        return False
    noise = float(np.median(np.concatenate([one.floor_db[below] for one, below in low])))
    return noise > ADDED_DB and float(np.median(lines)) < STAYED * noise


def _allowed(least_db: float, share: float, size_db: float) -> float:
    return max(least_db, min(share * size_db, MOST_DB))


def _level(change: FloatArray, c: int) -> float:
    """By how much the other channels' bands changed on the whole, dB: a rattling bearing is louder in one record than
    in another throughout. 0 where that is more than a record differs from the next."""
    rest = np.delete(change, c, axis=0)
    level = float(np.median(rest)) if rest.size else 0.0
    return level if abs(level) <= LEVEL_DB else 0.0


def _rough(own: FloatArray, curve: FloatArray, changed: BoolArray) -> float:
    """How unlike the changes (speeds, 2, bands) of lines and noise are, dB, in the bands that changed: all alike, or
    each kind alike at several speeds where the noise shows enough of it."""
    part = own[:, :, changed]
    alike = float(np.median(np.max(np.abs(part - curve[changed]), axis=(0, 1))))
    kinds = part.mean(axis=0)
    keeps = np.median(kinds[1] / np.where(np.abs(kinds[0]) > 0.0, kinds[0], 1.0))
    narrow = np.sum(changed) <= NARROW_BANDS
    if len(own) < LEAST_SPEEDS or not narrow or not FLOOR_KEEPS <= keeps <= FLOOR_MOST:
        return alike
    return min(alike, float(np.median(np.max(np.abs(part - kinds), axis=(0, 1)))))


def transferred(one: Recording, findings: Sequence[Finding], sign: int) -> Recording:
    """The recording with the changes of transfer of these findings undone (`sign` -1), or as it came (1)."""
    samples = one.samples.copy()
    for f in findings:
        if f.transfer_db and f.channel in one.names:
            row = one.names.index(f.channel)
            hz, change_db = np.asarray(f.transfer_db).T
            axis = np.fft.rfftfreq(samples.shape[1], 1 / one.sampling_rate_hz)
            factor = 10 ** (sign * np.interp(axis, hz, change_db) / 20)
            samples[row] = fft.irfft(fft.rfft(samples[row]) * factor, samples.shape[1])
    return replace(one, samples=samples)
