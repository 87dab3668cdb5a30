"""What can be hidden: each law changes the model's numbers, and says which registered terms describe it.

`terms` are the names of the product's registry that count as right; () marks physics that no library has. `levels` are
severities from faint to strong, in the unit of `severity` (the term's own severity parameter).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from proof.machine import Arrays, FloatArray
from proof.model.layout import B, G, M, Tooth, X

BEARINGS = ("bearing1", "bearing2", "bearing3", "bearing4")
GEARS = ("pinion", "gear")
SHAFTS = ("input", "output")
MESH = ("mesh1",)
LIPPED = 2
"""Variant of a pit whose edges stand up."""


@dataclass(frozen=True, kw_only=True)
class Choice:
    """What is chosen of a law: index of the site, severity, variant, and random numbers for the rest."""

    site: int
    value: float
    variant: int
    rng: np.random.Generator


Apply = Callable[[Arrays, Choice], None]


@dataclass(frozen=True, kw_only=True)
class Law:
    """One effect. `apply` changes the arrays in place."""

    sites: tuple[str, ...]
    terms: tuple[str, ...]
    severity: str
    unit: str
    levels: tuple[float, float, float, float]
    apply: Apply
    variants: int = 1
    also_at: Mapping[str, tuple[str, ...]] | None = None
    """Other names of a site that count as the right place."""
    torque_nm: float = 25.0
    """Load at which the effect can be seen."""
    sized: bool = True
    """Whether the severity means the same in the product's term."""


def _turn(rng: np.random.Generator) -> float:
    return float(rng.uniform(-math.pi, math.pi))


def fit(a: Arrays, c: Choice) -> None:
    """Outer ring loose in its seat: elastic seat (two contact laws), or a rigid bore."""
    b = a.bearings[c.site]
    b[B.FIT] = 2.0 if c.variant == 2 else 1.0
    b[B.FIT_GAP] = c.value
    b[B.FIT_N] = 1.5 if c.variant == 1 else 1.2
    b[B.FIT_K] = (3e11 if c.variant == 1 else 6e9) * c.rng.uniform(0.8, 1.2)
    b[B.FIT_LOSS] = c.rng.uniform(2.0, 5.0)
    b[B.FIT_MU] = c.rng.uniform(0.08, 0.15)
    b[B.FIT_PRESLIDE] = c.rng.uniform(1e-6, 3e-6)
    b[B.FIT_SHARE] = c.rng.uniform(0.1, 0.3)


def loose(a: Arrays, c: Choice) -> None:
    """Support that loses stiffness where the ring lifts; variant 1 lifts elsewhere."""
    b = a.bearings[c.site]
    b[B.LOOSE] = c.value
    b[B.LOOSE_LIFT] = 2e-6 * c.rng.uniform(-1.0, 1.0) if c.variant == 1 else 0.0
    b[B.LOOSE_SMOOTH] = c.rng.uniform(3e-7, 1e-6)


def race(width: B, depth: B, angle: B) -> Apply:
    """A pit of an outer race, an inner race or a ball."""

    def apply(a: Arrays, c: Choice) -> None:
        b = a.bearings[c.site]
        b[width] = c.value
        b[depth] = c.rng.uniform(6e-5, 1.5e-4)
        # the tooth force presses bearings 1, 2 towards +y and 3, 4 towards -y, weight presses towards -y: a pit of the
        # outer race in that zone
        loaded = 0.5 * math.pi if c.site < 2 and a.g[G.GRAVITY] == 0.0 else -0.5 * math.pi
        b[angle] = loaded + c.rng.uniform(-0.5, 0.5) if width is B.OUTER_WIDTH else _turn(c.rng)
        if c.variant == 1:
            b[B.SPALL_ENTRY], b[B.SPALL_EXIT], b[B.SPALL_PEAK] = 0.35, 0.15, 0.65
        if c.variant == LIPPED:
            b[B.LIP], b[B.LIP_LENGTH] = c.rng.uniform(1e-6, 4e-6), c.rng.uniform(1e-4, 3e-4)

    return apply


def wave(amplitude: B, order: B) -> Apply:
    """A wavy race, in the load zone or turning."""

    def apply(a: Arrays, c: Choice) -> None:
        b = a.bearings[c.site]
        b[amplitude] = c.value
        b[order] = float((6, 7, 8, 13)[int(c.rng.integers(0, 4))])
        b[B.WAVE_PHASE] = _turn(c.rng)

    return apply


def bearing(column: B, at: B | None = None, scale: float = 0.0, *, add: bool = False) -> Apply:
    """One column of a bearing; `at`: another one that becomes `scale`; `add`: on top of what is there."""

    def apply(a: Arrays, c: Choice) -> None:
        b = a.bearings[c.site]
        b[column] = b[column] + c.value if add else c.value
        if at is not None:
            b[at] = scale

    return apply


def mode(a: Arrays, c: Choice) -> None:
    """A mass on a spring at the seat."""
    b = a.bearings[c.site]
    b[B.MODE_MASS] = c.value
    b[B.MODE_HZ] = c.rng.uniform(500.0, 2500.0)
    b[B.MODE_ZETA] = c.rng.uniform(0.01, 0.04)
    b[B.MODE_AXIS] = 1.0


def shaft_crack(a: Arrays, c: Choice) -> None:
    """A crack that opens and closes as the shaft turns."""
    a.bearings[c.site][B.CRACK] = c.value
    a.bearings[c.site][B.CRACK_PHASE] = _turn(c.rng)


def tooth(change: Callable[[FloatArray, Choice], None]) -> Apply:
    """A change of one tooth, whichever."""

    def apply(a: Arrays, c: Choice) -> None:
        change(a.teeth[c.site, int(c.rng.integers(0, int(a.g[G.Z1 + c.site])))], c)

    return apply


def crack(tooth: FloatArray, c: Choice) -> None:
    """A soft root; variant 0: most in the middle of the path, 1: towards the tip."""
    tooth[Tooth.CRACK], tooth[Tooth.CRACK_FORM] = c.value, float(c.variant)


def pit(tooth: FloatArray, c: Choice) -> None:
    """A flank without contact over part of its path."""
    tooth[Tooth.SPALL] = min(c.value, 0.98)
    tooth[Tooth.SPALL_LENGTH] = c.rng.uniform(0.15, 0.35)
    tooth[Tooth.SPALL_CENTRE] = c.rng.uniform(0.4, 0.6)
    tooth[Tooth.SPALL_FLOOR] = c.rng.uniform(1e-5, 3e-5) if c.value > 0.99 else 0.0


def missing(tooth: FloatArray, c: Choice) -> None:
    """A tooth that carries less all along its path."""
    tooth[Tooth.MISSING] = min(c.value, 0.999)


def pitch(a: Arrays, c: Choice) -> None:
    """Teeth that stand unevenly; variant 1: neighbours alike."""
    n = int(a.g[G.Z1 + c.site])
    steps = c.rng.standard_normal(n)
    if c.variant == 1:  # neighbours alike, as a worn hob leaves them
        steps = np.convolve(np.concatenate([steps, steps]), [0.25, 0.5, 0.25], "same")[n // 2 : n // 2 + n]
    steps = steps - steps.mean()
    a.teeth[c.site, :n, Tooth.PITCH] = c.value * steps / float(np.std(steps))


def eccentric(a: Arrays, c: Choice) -> None:
    """A base circle off its axis."""
    a.mesh[M.ECC + c.site], a.mesh[M.ECC_PHASE + c.site] = c.value, _turn(c.rng)


def mesh(column: M) -> Apply:
    """One column of the mesh."""

    def apply(a: Arrays, c: Choice) -> None:
        a.mesh[column + c.site] = c.value
        if column is M.FRICTION:
            a.mesh[M.FRICTION_SPEED] = 0.05

    return apply


def turning(column: X, phase: X) -> Apply:
    """One column of a shaft and its phase."""

    def apply(a: Arrays, c: Choice) -> None:
        a.x[column + c.site], a.x[phase + c.site] = c.value, _turn(c.rng)

    return apply


def offset(a: Arrays, c: Choice) -> None:
    """A coupling with offset shafts; the severity is the force over 1e6 N/m, the term's default stiffness."""
    a.x[X.OFFSET_FORCE + c.site] = 1e6 * c.value
    a.x[X.OFFSET_ODD + c.site] = c.rng.uniform(0.1, 0.3)
    a.x[X.OFFSET_PHASE + c.site] = _turn(c.rng)


def ripple(a: Arrays, c: Choice) -> None:
    """A torque with an order of the shaft."""
    a.x[X.RIPPLE + c.site], a.x[X.RIPPLE_PHASE + c.site] = c.value, _turn(c.rng)
    a.x[X.RIPPLE_ORDER + c.site] = float((2, 3, 4, 6)[int(c.rng.integers(0, 4))])


def rub(a: Arrays, c: Choice) -> None:
    """A ring around a gear that its orbit touches."""
    a.x[X.RUB_K + c.site] = c.value
    a.x[X.RUB_GAP + c.site] = c.rng.uniform(1.0e-5, 2.0e-5)
    a.x[X.RUB_MU + c.site] = c.rng.uniform(0.05, 0.2)
    a.x[X.RUB_LOSS + c.site] = c.rng.uniform(0.2, 1.0)


def shaft(column: X) -> Apply:
    """One column of a shaft."""

    def apply(a: Arrays, c: Choice) -> None:
        a.x[column + c.site] = c.value

    return apply
