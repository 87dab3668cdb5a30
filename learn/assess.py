"""From samples to an answer: envelope spectra of stretches, features, probabilities, what speaks for them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from learn import features, geometries, unknown, whole
from learn.bank import MIN_TURNS, Bank, bank
from learn.features import Found
from learn.model import Head, Model
from learn.orders import FaultOrders
from learn.severity import severity_index
from learn.speed import HIGHEST_HZ, SEARCH, Speed, candidates
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

LONGEST_TURNS = 20.0
"""Longer recordings are read in equal stretches. Over many turns even the faint lines of a sound machine become
certain; over few only deep ones do. They show where lines are; longer recordings are answered by the whole."""
WHOLE = "whole"
"""Head of the features of `learn.whole`: it answers for recordings longer than a stretch, their geometry known."""
ANYWHERE = "anywhere"
"""Head of the features of `learn.geometries`: the same, their geometry unknown."""
SPEED_TURNS = 80.0
"""The stretch a speed is read from."""
MOST_STRETCHES = 12
MOST_LINES = 15.0
"""Bearing lines count for a speed up to this: a strong fault must not outweigh the shaft's own lines."""
LEAST_PROBABILITY = 1e-4
"""No single stretch excludes a class for good."""


@dataclass(frozen=True, kw_only=True)
class Assessment:
    """`probabilities` by class; what the strongest stretch showed: families (known geometry) or the one comb."""

    label: str
    probabilities: dict[str, float]
    found: dict[str, Found]
    comb: dict[str, float]
    stretches: int
    turns: float
    geometry: str
    severity: float | None
    """Index of `learn.severity`, mean over the stretches, where a race is named; higher is longer."""


def assess(
    channels: Sequence[FloatArray],
    rate_hz: float,
    speed_hz: float,
    model: Model,
    orders: FaultOrders | None,
    doubt: float = 0.0,
    likely: Sequence[float] = (),
) -> Assessment:
    """Class of a recording; channels are looked at together, as more bands. Too short a one to tell its speed is
    answered at each of the `likely` ones, and the answers' mean is taken."""
    head = model.heads["known" if orders is not None else "unknown"]
    parts = stretches(channels, rate_hz, speed_hz)
    rows, shown = [], []
    for part in parts:
        spectra = bank(part, rate_hz, speed_hz)
        rows.append(_row(spectra, orders, doubt))
        shown.append(spectra)
    p = pooled(head, np.stack([r[0] for r in rows]))
    wanted = {WHOLE} if orders is not None else {WHOLE, ANYWHERE}
    if len(parts) > 1 and wanted <= set(model.heads):
        p = of_whole(channels, rate_hz, speed_hz, model, orders, doubt)
    elif len(parts) == 1 and likely:
        p = np.mean([_of_pieces(channels, rate_hz, f, head, orders, doubt / len(likely)) for f in likely], axis=0)
    label = head.classes[int(np.argmax(p))]
    strongest = int(
        np.argmax([r[1].get("z", 0.0) if orders is None else max(f.z for f in r[2].values()) for r in rows])
    )
    return Assessment(
        label=label,
        probabilities=dict(zip(head.classes, (float(x) for x in p), strict=True)),
        found=rows[strongest][2],
        comb=rows[strongest][1],
        stretches=len(parts),
        turns=sum(s.turns for s in shown),
        geometry="known" if orders is not None else "unknown",
        severity=_severity(shown, [r[2] for r in rows], label),
    )


def _of_pieces(
    channels: Sequence[FloatArray],
    rate_hz: float,
    speed_hz: float,
    head: Head,
    orders: FaultOrders | None,
    doubt: float,
) -> FloatArray:
    """Probabilities (classes,) by stretches, at one speed."""
    parts = stretches(channels, rate_hz, speed_hz)
    return pooled(head, np.stack([_row(bank(part, rate_hz, speed_hz), orders, doubt)[0] for part in parts]))


def of_whole(
    channels: Sequence[FloatArray],
    rate_hz: float,
    speed_hz: float,
    model: Model,
    orders: FaultOrders | None,
    doubt: float = 0.0,
) -> FloatArray:
    """Probabilities (classes,) by the recording in as few parts as may be."""
    parts = [bank(part, rate_hz, speed_hz) for part in stretches(channels, rate_hz, speed_hz, whole.TURNS)]
    if orders is None:
        return pooled(model.heads[ANYWHERE], np.stack([geometries.vector(one, model.heads[WHOLE]) for one in parts]))
    return pooled(model.heads[WHOLE], np.stack([whole.vector(one, orders, doubt)[0] for one in parts]))


def _severity(shown: Sequence[Bank], found: Sequence[dict[str, Found]], label: str) -> float | None:
    values = [severity_index(s, f[label]) for s, f in zip(shown, found, strict=True) if label in f]
    told = [v for v in values if v is not None]
    return float(np.mean(told)) if told else None


def estimated(
    channels: Sequence[FloatArray], rate_hz: float, stated_hz: float | None, orders: FaultOrders | None
) -> Speed:
    """The speed that the shaft's lines make likeliest; without a stated one, bearing lines in the first stretch count
    too. Near a stated speed they say nothing, as the slip that is searched is as wide as the doubt."""
    fastest = HIGHEST_HZ if stated_hz is None else (1 + SEARCH) * stated_hz
    stretches(channels, rate_hz, fastest)  # refused where even that is too few turns
    found = candidates(channels, rate_hz, stated_hz)
    if stated_hz is not None:
        return found[0]
    best: tuple[float, Speed] | None = None
    for one in found:
        try:
            part = stretches(channels, rate_hz, one.speed_hz, SPEED_TURNS)[0]
        except SpecError:
            continue
        _, comb, families = _row(bank(part, rate_hz, one.speed_hz), orders, 0.0)
        lines = max((f.z for n, f in families.items() if n != "cage"), default=comb.get("z", 0.0))
        fit = one.standing + min(lines, MOST_LINES)
        if best is None or fit > best[0]:
            best = (fit, one)
    if best is None:
        raise SpecError(
            Problem(field="operating.speed_hz", message="is needed: no speed can be read", given=None, unit="Hz")
        )
    return best[1]


def _row(
    spectra: Bank, orders: FaultOrders | None, doubt: float
) -> tuple[FloatArray, dict[str, float], dict[str, Found]]:
    if orders is None:
        row, comb = unknown.vector(spectra)
        return row, comb, {}
    row, found = features.vector(spectra, orders, doubt)
    return row, {}, found


def pooled(head: Head, rows: FloatArray) -> FloatArray:
    """Probabilities (classes,) of stretches taken together: geometric mean, so that none decides alone."""
    p = np.maximum(head.probabilities(rows), LEAST_PROBABILITY)
    mean = np.exp(np.mean(np.log(p), axis=0))
    return np.asarray(mean / np.sum(mean), dtype=np.float64)


def stretches(
    channels: Sequence[FloatArray], rate_hz: float, speed_hz: float, longest: float = LONGEST_TURNS
) -> list[list[FloatArray]]:
    """Equal stretches of all channels, none longer than `longest` turns."""
    samples = min(c.size for c in channels)
    turns = samples / rate_hz * speed_hz
    if turns < MIN_TURNS:
        allowed = f"at least {MIN_TURNS / speed_hz:.3g}"
        raise SpecError(
            Problem(field="samples", message="are too few turns", given=samples / rate_hz, allowed=allowed, unit="s")
        )
    count = min(max(1, int(np.ceil(turns / longest))), MOST_STRETCHES)
    length = min(samples // count, int(longest * rate_hz / speed_hz))
    return [[np.asarray(c[i * length : (i + 1) * length], dtype=np.float64) for c in channels] for i in range(count)]
