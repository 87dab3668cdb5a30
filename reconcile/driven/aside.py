"""A law counted from a point beside rest: the same motion seen from rest, in the numbers of a spring.

A cubic and a constant force are a stiffer spring with an even part, counted from where the mass rests; the revised
machine then has another stiffness than anyone measures about rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from reconcile.driven.forced import Analysis
from reconcile.driven.machine import weighed
from reconcile.driven.model import Model
from reconcile.driven.motion import moved
from reconcile.force_law.library import CUBIC, ODD_SQUARE, QUADRATIC, QUINTIC, length

ANCHORED = frozenset({CUBIC.key, QUINTIC.key, ODD_SQUARE.key, QUADRATIC.key})
"""Laws of displacement that look otherwise from another point."""
FAR_FROM_REST, STIFFER = 0.04, 0.01
"""Distance from rest over half the travel, and difference of the stiffness about rest, that are told when both are
passed. Of 35 made recordings 28 with springs that are odd about rest were at most 0.024 off with 0.2 % in stiffness;
7 with an even part, or a quadratic one, 0.065 and more with 2.4 % and more."""
PLACE_OF_OFFSET = 3
"""Of the constant force in a model's vector."""
NEAR = 1e-3
"""Step of derivatives, over half the travel."""


@dataclass(frozen=True, kw_only=True)
class Aside:
    """Where a law is counted from, and the spring about rest; per unit of mass."""

    away: float
    """From rest to the point, in the channel's own unit of displacement (m where it is calibrated)."""
    travel: float
    """Half the travel."""
    push: float
    stiffness: float
    even: float
    """Of the square of the distance from rest."""
    odd: bool
    """Whether the law itself has no even part."""


def aside(found: Analysis) -> Aside | None:
    """What is to be told of a law that is counted from beside rest; None: it is counted from there, or nearly."""
    model, run = found.published, found.held_run
    shaped = [law for law in model.laws if not law.rate]
    if not shaped or any(law.key not in ANCHORED for law in shaped):
        return None
    push = model.offset + model.gain * float(np.mean(run.data.drive))
    travel = 0.5 * float(np.ptp(moved(model, run)[0]))
    rest = _rest(model, push)
    odd = all(law.key != QUADRATIC.key for law in shaped)
    if rest is None or not abs(rest) > FAR_FROM_REST * travel or (odd and not _sure(found)):
        return None
    step = NEAR * travel
    low, middle, high = (_spring(model, rest + k * step) for k in (-1, 0, 1))
    stiffness, even = (high - low) / (2.0 * step), (high - 2.0 * middle + low) / (2.0 * step**2)
    if stiffness <= 0.0 or abs(stiffness / model.stiffness - 1.0) < STIFFER:
        return None
    return Aside(away=abs(rest), travel=travel, push=abs(push), stiffness=stiffness, even=even, odd=odd)


def _spring(model: Model, z: float) -> float:
    """Force of the spring with its laws, at rest."""
    at, still = np.array([z]), np.zeros(1)
    named = zip(model.laws, model.coefficients, strict=True)
    return model.stiffness * z + sum(c * float(law.values(at, still)[0]) for law, c in named if not law.rate)


def _rest(model: Model, push: float) -> float | None:
    """Where the spring carries a constant force, the nearest to where the linear part alone would."""
    if model.stiffness <= 0.0:
        return None
    found = scipy.optimize.root_scalar(lambda z: _spring(model, z) - push, x0=0.0, x1=push / model.stiffness or 1e-12)
    return float(found.root) if found.converged else None


def _sure(found: Analysis) -> bool:
    """Whether the constant force is one at all."""
    _, low, high = found.final.interval(PLACE_OF_OFFSET)
    still = found.final.model.gain * float(np.mean(found.held_run.data.drive))
    return (low + still) * (high + still) > 0.0


def beside_rest(found: Analysis, said: Aside) -> str:
    """For the sentence: `, z counted from a point 1.33 mm from rest`."""
    return f", z counted from a point {_distance(found, said)} from rest"


def _distance(found: Analysis, said: Aside) -> str:
    if not found.held_run.data.calibrated:
        return f"{said.away / said.travel:.2g} of half the travel"
    return length(said.away)


def seen_from_rest(found: Analysis) -> tuple[str, ...]:
    """The limit: the same law about rest, and its stiffness beside the revised machine's."""
    said = aside(found)
    if said is None:
        return ()
    model, data = found.published, found.held_run.data
    if weighed(model, data):
        mass = 1.0 / model.gain
        force = f" of {mass * said.push:.3g} N, the input's mean with it"
        spring = f"it has {mass * said.stiffness:.5g} N/m (the revised machine {mass * model.stiffness:.5g} N/m)"
        part = f"an even part of {mass * said.even:.3g} N/m² z²"
    else:
        force, part = "", "an even part"
        spring = f"it has {said.stiffness / model.stiffness:.3g} times the revised machine's stiffness"
    what = "the spring is not odd" if said.odd else "the spring is another"
    text = (
        f"The law is counted from a point {_distance(found, said)} from rest, beside a constant force{force}. About "
        f"rest {what}: {spring} and {part}, which is the same law seen from there."
    )
    return (text,)
