"""Whether fitted laws are laws, or no more than a curve through a force of another form.

A few laws with free gaps and centres run through any smooth force and predict held-out motion well: an exponential
spring was a cubic, a one-sided spring and stops, tanh a square, a cubic and stops. That says what the force is, not
what makes it, so no law is named then.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.driven.channels import FloatArray
from reconcile.driven.forced import ALPHA, Analysis
from reconcile.driven.motion import moved
from reconcile.force_law.library import CUBIC, FRICTION, GAPPED, ODD_SQUARE, QUADRATIC, QUINTIC, Law

POWERS = frozenset({CUBIC.key, QUINTIC.key, ODD_SQUARE.key, QUADRATIC.key})
"""Laws that are counted from one point."""
A_CURVE = 3
"""Laws of one kind that are a curve through the force: of 16 made forces of one and two laws none needed as many, of
forces that no law has an exponential and tanh did."""
SLOW = 0.06
"""Speed from which friction is full, over the largest one (99 % of the time it is slower), above which it is not dry:
six made dry frictions (noise 0.1 to 1 %, with and without drag) came out full at 0.007 to 0.016 of it, where they were
made so at 0.003 to 0.015; a friction that falls with speed, which rises up to 0.18 of it, at 0.13."""


def form(found: Analysis) -> tuple[str, tuple[str, ...]]:
    """The kind of force that the fitted laws only run through (`restoring`, `damping`; nothing: they are laws), and
    what tells that."""
    laws = found.final.model.laws
    if not laws:
        return "", ()
    parts = [moved(found.final.model, run) for run in (found.fitted_run, found.held_run)]
    z, v = (np.concatenate(several) for several in zip(*parts, strict=True))
    unlike = found.left is not None and found.left.p_value < ALPHA and not any(x.led for x in found.validations)
    kinds = [("restoring", [x for x in laws if not x.rate]), ("damping", [x for x in laws if x.rate])]
    told = {kind: _told(kind, several, unlike, z, v) for kind, several in kinds}
    first = next((kind for kind in told if told[kind]), "")
    return first, tuple(said for several in told.values() for said in several)


def _told(kind: str, laws: Sequence[Law], unlike: bool, z: FloatArray, v: FloatArray) -> list[str]:
    """Of the laws of one kind; `unlike`: what they leave is not noise."""
    said = [f"{law.words} ({law.shown()}) {why}" for law in laws if (why := _outside(law, z, v))]
    if len(laws) >= A_CURVE:
        said.append(f"{len(laws)} {kind} laws together are a curve through the force")
    elif unlike and len(laws) > 1:
        said.append(f"{len(laws)} {kind} laws together leave what is not noise")
    return said


def _outside(law: Law, z: FloatArray, v: FloatArray) -> str:
    """Why the motion does not show this law, along displacements and speeds; empty where it does."""
    low, high = float(z.min()), float(z.max())
    if law.key in POWERS and not low < 0.0 < high:
        return "is counted from a point outside of the travel"
    if law.key in GAPPED and not all(low < gap < high for gap in _gaps(law)):
        return "has its gap outside of the travel"
    if law.key == FRICTION.key and law.shape > SLOW * float(np.quantile(np.abs(v), 0.99)):
        return "is full only at a speed that is not slow: dry friction is at once"
    return ""


def _gaps(law: Law) -> tuple[float, ...]:
    """Displacements at which it begins to push."""
    if law.key == "stops":
        return law.shape, -law.shape
    return (-law.shape,) if law.key.endswith("below") else (law.shape,)
