"""From samples to an answer: envelope spectra of stretches, features, probabilities, what speaks for them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from learn import geometries
from learn.bank import Bank, bank
from learn.features import Found
from learn.looked import Looked, row_of, stretches
from learn.model import Head, Model
from learn.orders import FaultOrders
from learn.severity import severity_index
from learn.speed import HIGHEST_HZ, SEARCH, Speed, candidates
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

HEALTHY = "healthy"
KNOWN, UNKNOWN = "known", "unknown"
"""Heads of stretches, by whether the geometry is known."""
WHOLE = "whole"
"""Head of the features of `learn.whole`: it answers for recordings longer than a stretch, their geometry known."""
ANYWHERE = "anywhere"
"""Head of the features of `learn.geometries`: the same, their geometry unknown."""
SPEED_TURNS = 80.0
"""The stretch a speed is read from."""
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
    seen = Looked(channels=tuple(channels), rate_hz=rate_hz, speed_hz=speed_hz, orders=orders, doubt=doubt)
    return answered(seen, model, likely)


def answered(seen: Looked, model: Model, likely: Sequence[float] = ()) -> Assessment:
    """The same, of a recording that was looked at: what several models say of it needs one look."""
    orders = seen.orders
    head = model.heads[KNOWN if orders is not None else UNKNOWN]
    wanted = {WHOLE} if orders is not None else {WHOLE, ANYWHERE}
    p = pooled(head, seen.table)
    if len(seen.shown) > 1 and wanted <= set(model.heads):
        p = of_whole(seen, model)
    elif len(seen.shown) == 1 and likely:
        tried = [replace(seen, speed_hz=f, doubt=seen.doubt / len(likely)) for f in likely]
        p = np.mean([pooled(head, one.table) for one in tried], axis=0)
    label = head.classes[int(np.argmax(p))]
    rows = seen.rows
    strongest = int(
        np.argmax([r[1].get("z", 0.0) if orders is None else max(f.z for f in r[2].values()) for r in rows])
    )
    return Assessment(
        label=label,
        probabilities=dict(zip(head.classes, (float(x) for x in p), strict=True)),
        found=rows[strongest][2],
        comb=rows[strongest][1],
        stretches=len(seen.shown),
        turns=sum(s.turns for s in seen.shown),
        geometry="known" if orders is not None else "unknown",
        severity=_severity(seen.shown, [r[2] for r in rows], label),
    )


def check_heads(model: Model, known: bool) -> None:
    """SpecError for a model that cannot answer, the geometry `known` or not: the head is missing, none of its classes
    is the sound one, or those of long recordings name other classes."""
    name, more = (KNOWN, (WHOLE,)) if known else (UNKNOWN, (WHOLE, ANYWHERE))
    if name not in model.heads:
        told = ", ".join(sorted(model.heads))
        raise SpecError(
            Problem(field="model.heads", message=f"lack `{name}`", given=told, allowed=f"`{name}` at least")
        )
    classes = model.heads[name].classes
    if HEALTHY not in classes:
        given = ", ".join(classes)
        message = "has no class of sound machines"
        raise SpecError(Problem(field=f"model.heads.{name}.classes", message=message, given=given, allowed=HEALTHY))
    for other in more:
        if other in model.heads and model.heads[other].classes != classes:
            given = ", ".join(model.heads[other].classes)
            message = f"differs from that of `{name}`"
            field, allowed = f"model.heads.{other}.classes", ", ".join(classes)
            raise SpecError(Problem(field=field, message=message, given=given, allowed=allowed))


def of_whole(seen: Looked, model: Model) -> FloatArray:
    """Probabilities (classes,) by the recording in as few parts as may be."""
    if seen.orders is not None:
        return pooled(model.heads[WHOLE], seen.long_table)
    return pooled(model.heads[ANYWHERE], np.stack([geometries.vector(one, model.heads[WHOLE]) for one in seen.long]))


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
        _, comb, families = row_of(bank(part, rate_hz, one.speed_hz), orders, 0.0)
        lines = max((f.z for n, f in families.items() if n != "cage"), default=comb.get("z", 0.0))
        fit = one.standing + min(lines, MOST_LINES)
        if best is None or fit > best[0]:
            best = (fit, one)
    if best is None:
        raise SpecError(
            Problem(field="operating.speed_hz", message="is needed: no speed can be read", given=None, unit="Hz")
        )
    return best[1]


def pooled(head: Head, rows: FloatArray) -> FloatArray:
    """Probabilities (classes,) of stretches taken together: geometric mean, so that none decides alone."""
    p = np.maximum(head.probabilities(rows), LEAST_PROBABILITY)
    mean = np.exp(np.mean(np.log(p), axis=0))
    return np.asarray(mean / np.sum(mean), dtype=np.float64)
