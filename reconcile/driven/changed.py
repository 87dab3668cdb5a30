"""Is the oscillator still the one of the baseline? Mass, stiffness and damping of both, with what they may be off.

A change is told only where the intervals of all tests lie on one side of those of all baselines, and by more than
models of one oscillator differ by. Where force or motion have no units the frequency and the damping rate are compared.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.driven.doubt import doubted
from reconcile.driven.fit import GAIN, Fitted, descend
from reconcile.driven.machine import Site, weighed
from reconcile.driven.measured import FITS, LEAST_KEPT, Look
from reconcile.driven.model import ready, share_kept
from reconcile.shares import two_digits

LEAST = {"stiffness": 0.03, "damping": 0.15, "mass": 0.03}
"""Change over the baseline's value that is told. Of 60 pairs of sound made recordings (1 to 40 % noise on the motion, 5
and 20 % on the force, damping ratios of 0.005 to 0.3) the farthest were 2.2, 2.5 and 2.1 % apart; damping besides
changes with the motion's size on most machines."""
ONE_FACTOR = 0.02
"""Within which mass and stiffness have changed by one factor, as another sensitivity makes it look."""
PER_MASS = {"stiffness": "1/s^2", "damping": "1/s"}


@dataclass(frozen=True, kw_only=True)
class Number:
    """A number of the oscillator with its 90 % interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, kw_only=True)
class Change:
    """A number that is another than in the baseline; `name` is the machine file's, `words` the reader's."""

    key: str
    name: str
    words: str
    unit: str
    before: Number
    after: Number

    @property
    def ratio(self) -> float:
        """Of the test over the baseline."""
        return self.after.value / self.before.value

    def told(self) -> str:
        """`stiffness 70 000 N/m instead of 95 000 N/m (26 % lower; 90 %: ... to ...)`."""
        unit = f" {self.unit}" if self.unit else ""
        way = f"{two_digits(abs(self.ratio - 1.0))} {'higher' if self.ratio > 1.0 else 'lower'}"
        return (
            f"{self.words} {self.after.value:.5g}{unit} (90 %: {self.after.low:.5g} to {self.after.high:.5g}) instead "
            f"of {self.before.value:.5g}{unit} ({self.before.low:.5g} to {self.before.high:.5g}), {way}"
        )


def _fitted(one: Look) -> Fitted | None:
    """Fit of a whole recording with its doubts; None where a linear model does not carry it."""
    run = ready(one.data, one.model.memory_s)
    if one.left > FITS or share_kept(run) < LEAST_KEPT:
        return None
    return doubted(descend(one.model, [run]), [run], None)


def numbers(found: Fitted, weighs: bool) -> dict[str, Number]:
    """Mass, stiffness and damping; without units the squared frequency and the damping over the mass."""
    said = {
        "stiffness": Number(**dict(zip(("value", "low", "high"), found.interval(0, per_gain=weighs), strict=True))),
        "damping": Number(**dict(zip(("value", "low", "high"), found.interval(1, per_gain=weighs), strict=True))),
    }
    if weighs:
        gain, low, high = found.interval(GAIN)
        said["mass"] = Number(value=1.0 / gain, low=1.0 / high, high=1.0 / low if low > 0.0 else math.inf)
    return said


def changes(
    tests: Sequence[Look], baselines: Sequence[Look], site: Site, law: Fitted | None = None
) -> tuple[Change, ...]:
    """What changed of the oscillator; nothing where a test or all baselines cannot be fitted.

    `law`: the model with laws that the tests are explained by; its linear part is compared then.
    """
    weighs = bool(baselines) and all(weighed(x.model, x.data) for x in (*tests, *baselines))
    there = [f for f in map(_fitted, baselines) if f is not None]
    here = [f for f in map(_fitted, tests) if f is not None] if law is None else [law]
    if not there or len(here) < (len(tests) if law is None else 1):
        return ()
    now, then = ([numbers(f, weighs) for f in found] for found in (here, there))
    found = [_change(key, [n[key] for n in now], [n[key] for n in then], weighs, site) for key in now[0]]
    return tuple(change for change in found if change is not None)


def one_factor(found: Sequence[Change]) -> bool:
    """Whether mass and stiffness changed alike: another sensitivity of force or motion looks the same."""
    ratios = {c.key: c.ratio for c in found}
    return {"mass", "stiffness"} <= set(ratios) and abs(ratios["mass"] / ratios["stiffness"] - 1.0) < ONE_FACTOR


def _change(key: str, now: Sequence[Number], then: Sequence[Number], weighs: bool, site: Site) -> Change | None:
    after, before = _joined(now), _joined(then)
    apart = after.low > before.high or after.high < before.low
    if not apart or before.value <= 0.0 or abs(after.value / before.value - 1.0) < LEAST[key]:
        return None
    names = {
        "stiffness": (f"stiffness_{site.axis}_n_per_m", "N/m"),
        "damping": (f"damping_{site.axis}_ns_per_m", "N s/m"),
        "mass": ("mass_kg", "kg"),
    }
    name, unit = names[key]
    if not weighs:
        words, unit = f"{key} over mass", PER_MASS[key]
        return Change(key=key, name=f"{key}_over_mass", words=words, unit=unit, before=before, after=after)
    return Change(key=key, name=name, words=key, unit=unit, before=before, after=after)


def _joined(several: Sequence[Number]) -> Number:
    """One number for recordings alike: the mean, and an interval that holds all of them."""
    return Number(
        value=float(np.mean([n.value for n in several])),
        low=min(n.low for n in several),
        high=max(n.high for n in several),
    )
