"""Candidate laws of a force between two parts: what each is in words, as a formula of the specification, and its value.

z is the relative displacement, v its rate. A law's force is coefficient * value, as a resistance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from reconcile.force_law.kernels import column

FloatArray = NDArray[np.float64]

SLOW = 0.02
"""Speed at which dry friction is fully developed, as a share of the largest one."""
GAP_QUANTILES = (0.1, 0.25, 0.5, 0.75, 0.9)
ZONE_QUANTILES = (0.25, 0.5, 0.75, 0.9)
MILLIMETRES = 1e-4
"""Length, m, from which on it is told in mm."""


def length(metres: float) -> str:
    """In mm or µm, as a machinist says it."""
    return f"{metres * 1e3:.3g} mm" if abs(metres) >= MILLIMETRES else f"{metres * 1e6:.3g} µm"


@dataclass(frozen=True, kw_only=True)
class Law:
    """A candidate: `shape` is its gap, exponent or speed; `power` the power of metres (of m/s) the value grows with."""

    key: str
    code: int
    words: str
    formula: str
    """In the language of `custom_laws`, `{s}` the shape."""
    text: str
    """For readers, `{s}` the shape."""
    power: float
    rate: bool = False
    """Whether it resists motion rather than displacement."""
    shape: float = 0.0

    def values(self, z: FloatArray, v: FloatArray) -> FloatArray:
        """Along a motion, (n,)."""
        out = np.empty(z.size)
        column(self.code, self.shape, np.ascontiguousarray(z), np.ascontiguousarray(v), out)
        return out

    def expression(self, coefficient: float) -> str:
        """The force as a formula of the specification."""
        shape = f"{self.shape:.9g}" if self.shape >= 0 else f"(-{-self.shape:.9g})"
        return f"{coefficient:.9g}*{self.formula.format(s=shape)}"

    def shown(self) -> str:
        """For readers, with the shape in figures, a gap in mm or µm: `(z + 0.506 mm)₊`."""
        shape = length(self.shape) if self.key in GAPPED else f"{self.shape:.3g}"
        return self.text.format(s=shape).replace("− -", "+ ")

    @property
    def unit(self) -> str:
        """Unit of the coefficient."""
        base = "(m/s)" if self.rate and self.key != "van_der_pol" else "m"
        if self.key == "van_der_pol":
            return "N*s/m^3"
        if self.power == 0:
            return "N"
        return f"N/{base}" if self.power == 1 else f"N/{base}^{self.power:.3g}"


QUADRATIC = Law(key="quadratic", code=0, words="even stiffness", formula="x^2", text="z²", power=2)
CUBIC = Law(key="cubic", code=1, words="cubic support, odd stiffness", formula="x^3", text="z³", power=3)
QUINTIC = Law(key="quintic", code=2, words="odd stiffness, fifth power", formula="x^5", text="z⁵", power=5)
ODD_SQUARE = Law(key="odd_square", code=3, words="odd stiffness, square", formula="x*abs(x)", text="z|z|", power=2)
ABOVE = Law(key="contact_above", code=4, words="one-sided spring", formula="max(x-{s},0)", text="(z − {s})₊", power=1)
HERTZ_ABOVE = Law(
    key="hertz_above", code=5, words="one-sided Hertz contact", formula="max(x-{s},0)^1.5", text="(z − {s})₊^1.5",
    power=1.5,
)  # fmt: skip
BELOW = Law(key="contact_below", code=6, words="one-sided spring", formula="min(x+{s},0)", text="−(−z − {s})₊", power=1)
HERTZ_BELOW = Law(
    key="hertz_below", code=7, words="one-sided Hertz contact", formula="(-1)*max(-x-{s},0)^1.5",
    text="−(−z − {s})₊^1.5", power=1.5,
)  # fmt: skip
STOPS = Law(
    key="stops", code=8, words="stops on both sides", formula="sign(x)*max(abs(x)-{s},0)", text="sgn z (|z| − {s})₊",
    power=1,
)  # fmt: skip
FREE_POWER = Law(
    key="odd_power", code=9, words="odd stiffness", formula="sign(x)*abs(x)^{s}", text="sgn z |z|^{s}", power=math.nan
)
FRICTION = Law(
    key="dry_friction", code=10, words="dry friction", formula="max(min(v/{s},1),-1)", text="sgn ż", power=0, rate=True
)
DRAG = Law(key="drag", code=11, words="quadratic damping", formula="v*abs(v)", text="ż|ż|", power=2, rate=True)
CUBIC_DRAG = Law(key="cubic_drag", code=12, words="cubic damping", formula="v^3", text="ż³", power=3, rate=True)
VAN_DER_POL = Law(
    key="van_der_pol", code=13, words="damping that grows with the swing", formula="x^2*v", text="z²ż", power=3,
    rate=True,
)  # fmt: skip
ROOT = Law(key="root", code=14, words="square root", formula="sign(x)*sqrt(abs(x))", text="sgn z √|z|", power=0.5)

SMOOTH = (QUADRATIC, CUBIC, QUINTIC, ODD_SQUARE, ROOT, DRAG, CUBIC_DRAG, VAN_DER_POL)


GAPPED = frozenset({"contact_above", "hertz_above", "contact_below", "hertz_below", "stops"})
"""Laws whose shape is a gap."""
PUSHING = frozenset({"hertz_above", "hertz_below", "stops"})
"""Contacts: their stiffness is positive, whatever fits. (Of a one-sided spring the twin is: `mirrored`.)"""
UNANCHORED = GAPPED | {"dry_friction", "drag", "cubic_drag"}
"""Laws that do not tell where displacement is counted from: a gap moves along, or it does not count.

Stops with a free middle could leave one side for good, and be a one-sided spring under another name.
"""


def mirrored(law: Law) -> Law | None:
    """The twin of a one-sided spring: (z - s)+ = z - s + (s - z)+, from the other side with the sign turned.

    Beside a linear spring and a constant force, which are free, no recording tells the two apart.
    """
    twin = {"contact_above": BELOW, "contact_below": ABOVE}.get(law.key)
    return replace(twin, shape=-law.shape) if twin is not None else None


def library(z: FloatArray, v: FloatArray) -> tuple[Law, ...]:
    """All candidates, gaps at quantiles of the motion."""
    found = list(SMOOTH)
    gaps = np.unique(np.quantile(z, GAP_QUANTILES))
    found += [replace(law, shape=float(g)) for law in (ABOVE, HERTZ_ABOVE) for g in gaps]
    found += [replace(law, shape=float(-g)) for law in (BELOW, HERTZ_BELOW) for g in gaps]
    found += [replace(STOPS, shape=float(g)) for g in np.unique(np.quantile(np.abs(z), ZONE_QUANTILES))]
    fastest = float(np.quantile(np.abs(v), 0.99))
    return (*found, replace(FRICTION, shape=SLOW * fastest)) if fastest > 0 else tuple(found)
