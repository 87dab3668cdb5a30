"""The picture of the level of kinematics: the envelope order spectrum in which the firmest family stands."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.kinematics.answer import SYMBOLS
from reconcile.kinematics.candidate import Candidate
from reconcile.kinematics.contrast import band_turns
from reconcile.kinematics.envelopes import order_depth
from reconcile.kinematics.evidence import Evidence
from reconcile.kinematics.families import Family
from reconcile.kinematics.foreign import Foreign
from reconcile.kinematics.observe import Observation
from reconcile.verdict import Cause

POINTS = 1200
"""Of a curve; of more bins the largest of each stretch is kept, which keeps lines."""
HARMONICS_SHOWN = 3
BEYOND = 1.13
"""Orders shown over the highest line."""
NEAREST = 4
"""Lines of parts that are shown beside impacts of none."""


def envelope_picture(
    every: Sequence[Candidate],
    causes: Sequence[Cause],
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
) -> dict[str, object]:
    """`{"envelope": ...}` of the band, in the test that shows it best, of the family that the answer rests on, and the
    baseline nearest in speed.

    `depth` of `test` and `baseline`: amplitude of the squared envelope over its mean (0 to 2) from order 0 on, a value
    every `order_step` orders of the reference shaft; `lines`: the orders of the family (`own`), its sidebands, and of
    other parts at the same place. Where no family is there, the band in which one comes nearest to it, with neither
    `family` nor `order` and no `lines`. Empty without candidates.
    """
    if not every:
        return {}
    rested = of_the_answer(every, causes)
    chosen = rested or every[0]
    best, test = chosen.best, tests[chosen.strongest]
    lines = [*_own(chosen), *_others(chosen, every)]
    top = BEYOND * max(float(str(line["order"])) for line in lines)
    named: dict[str, object] = {"lines": []}
    if rested is not None:
        named = {"family": chosen.family.key, "order": best.order, "lines": lines}
    return {"envelope": {**named, **_band(best, test), **_curves(best, test, baselines, top)}}


def _band(best: Evidence, test: Observation) -> dict[str, object]:
    """Where it was heard best."""
    return {
        "band_hz": list(best.band_hz),
        "channel": best.channel,
        "shaft": test.speed.shaft,
        "speed_hz": test.speed.speed_hz,
    }


def _curves(best: Evidence, test: Observation, baselines: Sequence[Observation], top: float) -> dict[str, object]:
    """Of the test and of the baseline nearest in speed, up to an order."""
    shown: dict[str, object] = {}
    near = sorted(baselines, key=lambda b: abs(b.speed.speed_hz - test.speed.speed_hz))[:1]
    for name, group in (("test", [test]), ("baseline", near)):
        for one in group:
            if best.channel in one.recording.names and best.band_hz[1] < one.recording.sampling_rate_hz / 2:
                shown[name] = {"label": one.label, **_curve(one, best.channel, best.band_hz, top)}
    return shown


def comb_picture(
    found: Foreign, every: Sequence[Candidate], test: Observation, baselines: Sequence[Observation]
) -> dict[str, object]:
    """The same of impacts at an order of no part, with the nearest lines of parts; it has no `family`."""
    order, best = found.order, found.evidence
    own = [
        {"label": f"{order:.4g}" if k == 1 else f"{k} x {order:.4g}", "order": k * order, "kind": "own"}
        for k in range(1, HARMONICS_SHOWN + 1)
    ]
    near = sorted(every, key=lambda c: abs(c.best.order - order))[:NEAREST]
    others = [
        {"label": _named(c.family, 1), "order": _place(c), "kind": "other"}
        for c in near
        if _place(c) < HARMONICS_SHOWN * order
    ]
    shown: dict[str, object] = {"order": order, "lines": [*own, *others], **_band(best, test)}
    return {"envelope": {**shown, **_curves(best, test, baselines, BEYOND * HARMONICS_SHOWN * order)}}


def of_the_answer(every: Sequence[Candidate], causes: Sequence[Cause]) -> Candidate | None:
    """The candidate that the answer rests on: that of the first cause whose lines are there, or without one the first
    whose lines are; None where no family's are.

    A louder family may be there that sound machines have too, such as once a turn; a cause that is no defect of a
    bearing, such as a rub, has the turn of its shaft.
    """
    for cause in causes:
        for c in every:
            if (c.present or cause.named) and c.family.site == cause.site and _brings(cause, c.family):
                return c
    return next((c for c in every if c.present), next((c for c in every if c.driven), None))


def _brings(cause: Cause, family: Family) -> bool:
    """Whether a cause at the family's place makes its lines."""
    return family.kind == "turn" or cause.term.startswith(family.kind)


def _curve(one: Observation, channel: str, band_hz: tuple[float, float], top: float) -> dict[str, object]:
    depth, step = order_depth(*band_turns(one, channel, band_hz))
    depth = depth[: int(np.ceil(top / step)) + 1]
    pool = max(1, -(-depth.size // POINTS))
    padded = np.pad(depth, (0, -depth.size % pool))
    pooled = padded.reshape(-1, pool).max(axis=1)
    return {"order_step": step * pool, "depth": [float(round(d, 5)) for d in pooled]}


def _own(chosen: Candidate) -> list[dict[str, object]]:
    """Harmonics of the family at the order found, and their sidebands."""
    family, order = chosen.family, chosen.best.order
    found: list[dict[str, object]] = []
    count = family.harmonics if family.kind == "turn" else min(HARMONICS_SHOWN, family.harmonics)
    for k in range(family.lowest, count + 1):
        found.append({"label": _named(family, k), "order": k * order, "kind": "own"})
        for m in range(1, family.sidebands + 1):
            pair = (k * order - m * family.spacing, k * order + m * family.spacing)
            found += [{"label": "", "order": o, "kind": "sideband"} for o in pair if o > 0]
    return found


def _named(family: Family, k: int) -> str:
    """`BPFO`, `2 BPFO`; a ball strikes twice a spin: `2 BSF`, `4 BSF`."""
    if family.kind == "ball":
        return f"{2 * k} BSF"
    symbol = family.site if family.kind == "turn" else SYMBOLS[family.kind]
    return symbol if k == 1 else f"{k} {symbol}"


def _others(chosen: Candidate, every: Sequence[Candidate]) -> list[dict[str, object]]:
    """First lines of the other families of the same bearing, and once a turn of the shafts."""
    own = chosen.family
    return [
        {"label": _named(c.family, 1), "order": _place(c), "kind": "other"}
        for c in every
        if c is not chosen and (c.family.site == own.site or c.family.kind == "turn") and _place(c) < 3 * own.order
    ]


def _place(other: Candidate) -> float:
    """Where a part's first line stands, or would by the drawing: the best place within the slip of a part that is not
    heard is another part's sideband."""
    return other.best.order if other.present else other.family.order
