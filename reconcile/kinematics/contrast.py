"""Is it more than in the baseline? A sound bearing shows its own lines too, up to 25 dB over the floor.

The measure is the depth of modulation (lines of the squared envelope over its mean): it knows no gain and no
transfer path. Both recordings are looked at in the band where the test shows the family best; the scatter is that of
blocks of turns.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.kinematics.comb_scores import scores, trials
from reconcile.kinematics.envelopes import Envelopes, at_equal_angles, order_depth, squared_envelope
from reconcile.kinematics.evidence import Evidence, comb_depth, logs
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.observe import Observation
from reconcile.speed.excess import power_over_floor
from signals.series import FloatArray

BLOCKS = 4
MIN_BLOCK_TURNS = 12.0
LEAST_DEPTH = 0.02
"""Below this a depth is not told from zero: it bounds the ratio of a strong line to none."""


@dataclass(frozen=True, kw_only=True)
class Contrast:
    """Growth of a family's depth over the deepest baseline, dB, with its standard error; None without a baseline."""

    depth: float
    before: float | None
    growth_db: float | None
    error_db: float


def contrast(evidence: Evidence, test: Observation, baselines: Sequence[Observation], ties: Ties) -> Contrast:
    """Depth of the family in the test against the same channel and band of the baselines."""
    ((depth, own_error),) = _depths(test, evidence, ties, [evidence.order])
    heard = [
        b
        for b in baselines
        if evidence.channel in b.recording.names and evidence.band_hz[1] < b.recording.sampling_rate_hz / 2
    ]
    # where the baseline's own search may not look (multiples of a shaft) the test's order is asked of it too
    rows = [row for b in heard for row in _depths(b, evidence, ties, [None, evidence.order])]
    if not rows:
        return Contrast(depth=depth, before=None, growth_db=None, error_db=own_error)
    before, error = max(rows, key=lambda row: row[0])
    growth = 20 * np.log10(max(depth, LEAST_DEPTH) / max(before, LEAST_DEPTH))
    return Contrast(
        depth=depth, before=before, growth_db=float(growth), error_db=float(np.hypot(own_error, min(error, 3.0)))
    )


def band_turns(observation: Observation, channel: str, band_hz: tuple[float, float]) -> tuple[FloatArray, int]:
    """(squared envelope of a band at equal angles of the reference shaft, over its mean; steps a turn)."""
    return observation.kept.of((channel, band_hz), lambda: _band_turns(observation, channel, band_hz))


def _band_turns(observation: Observation, channel: str, band_hz: tuple[float, float]) -> tuple[FloatArray, int]:
    e = observation.channel(channel)
    assert e is not None
    rate = observation.recording.sampling_rate_hz
    square, envelope_rate, _ = squared_envelope(observation.white(channel), band_hz[0], band_hz[1], rate)
    per_turn = int(np.ceil(2.2 * e.order_step * e.excess.shape[1] / 1.1))
    return at_equal_angles(square, envelope_rate, e.angle_rad, rate, per_turn), per_turn


def single_band(values: FloatArray, per_turn: int, like: Envelopes) -> Envelopes:
    """Envelope spectra of one stretch of one band."""
    depth, step = order_depth(values, per_turn)
    return replace(
        like,
        bands_hz=like.bands_hz[:1],
        order_step=step,
        excess=power_over_floor(depth**2)[np.newaxis],
        depth=depth[np.newaxis],
        kurtosis=like.kurtosis[:1],
        turns=values.size / per_turn,
    )


def _depths(
    observation: Observation, evidence: Evidence, ties: Ties, orders: Sequence[float | None]
) -> list[tuple[float, float]]:
    """(depth over the whole record, standard error in dB from blocks) at each of `orders`, in the channel and band of
    the evidence; None: where it is deepest."""
    like = observation.channel(evidence.channel)
    assert like is not None
    values, per_turn = band_turns(observation, evidence.channel, evidence.band_hz)
    whole = single_band(values, per_turn, like)
    count = min(BLOCKS, int(whole.turns / MIN_BLOCK_TURNS))
    blocks = np.array_split(values, count) if count >= 2 else []
    parts = [single_band(block, per_turn, like) for block in blocks]
    return [_depth(observation, whole, parts, evidence.family, ties, order) for order in orders]


def _depth(
    observation: Observation,
    whole: Envelopes,
    parts: Sequence[Envelopes],
    family: Family,
    ties: Ties,
    order: float | None,
) -> tuple[float, float]:
    if order is None:
        base = trials(family, family.order, family.slip + observation.doubt, whole.order_step)
        table = scores(logs(whole, ties, shaft_lines=family.kind == "turn"), whole, family, base)
        order = float(base[int(np.argmax(table[0]))])
    depth = comb_depth(whole, 0, family, order)
    if not parts:
        return depth, 3.0
    depths = [max(comb_depth(p, 0, family, order), LEAST_DEPTH) for p in parts]
    return depth, float(20 * np.std(np.log10(depths), ddof=1) / np.sqrt(len(parts)))
