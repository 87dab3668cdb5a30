"""Units that recordings come in, and what they are in SI: one table. What is not in it is refused, never guessed.

Factors are exact by definition: standard gravity 9.80665 m/s^2 (3rd CGPM 1901, resolution 2; ISO 80000-4:2019), the
inch 0.0254 m and the pound 0.453 592 37 kg (international yard and pound agreement of 1959; NIST SP 811, 2008 edition,
appendix B.8), hence the pound-force 4.448 221 615 260 5 N.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from sim.core.errors import Problem, SpecError

GRAVITY_M_PER_S2 = 9.80665
INCH_M = 0.0254
FOOT_M = 12 * INCH_M
POUND_FORCE_N = 0.45359237 * GRAVITY_M_PER_S2
ELECTRICAL = "voltage"
UNCALIBRATED = "uncalibrated"
"""Unit of samples whose scale nobody knows: shapes and ratios mean something, levels do not."""


@dataclass(frozen=True, kw_only=True)
class Unit:
    """A stored value x `factor` + `offset` is in `si`; `quantity` is what the unit measures (empty: several things)."""

    si: str
    factor: float
    quantity: str = ""
    offset: float = 0.0


_FACTORS: tuple[tuple[str, str, Mapping[str, float]], ...] = (
    (
        "acceleration",
        "m/s^2",
        {
            **dict.fromkeys(("m/s^2", "m/s2", "m/s/s", "m.s^-2", "m.s-2"), 1.0),
            **dict.fromkeys(("mm/s^2", "mm/s2"), 1e-3),
            **dict.fromkeys(("g", "gn", "g0", "g_n"), GRAVITY_M_PER_S2),
            **dict.fromkeys(("mg", "milli-g"), 1e-3 * GRAVITY_M_PER_S2),
            **dict.fromkeys(("in/s^2", "in/s2"), INCH_M),
            **dict.fromkeys(("ft/s^2", "ft/s2"), FOOT_M),
        },
    ),
    (
        "velocity",
        "m/s",
        {
            **dict.fromkeys(("m/s", "m.s^-1", "m.s-1"), 1.0),
            **dict.fromkeys(("mm/s", "mm.s^-1"), 1e-3),
            "um/s": 1e-6,
            **dict.fromkeys(("in/s", "ips"), INCH_M),
            "ft/s": FOOT_M,
        },
    ),
    (
        "displacement",
        "m",
        {
            "m": 1.0,
            "cm": 1e-2,
            "mm": 1e-3,
            **dict.fromkeys(("um", "micron", "microns"), 1e-6),
            "nm": 1e-9,
            **dict.fromkeys(("in", "inch"), INCH_M),
            **dict.fromkeys(("mil", "mils", "thou"), 1e-3 * INCH_M),
            "ft": FOOT_M,
        },
    ),
    (
        "force",
        "N",
        {
            "N": 1.0,
            "mN": 1e-3,
            "kN": 1e3,
            "MN": 1e6,
            # A recorded channel in pounds is a force: a mass does not vibrate.
            **dict.fromkeys(("lb", "lbs", "lbf"), POUND_FORCE_N),
            **dict.fromkeys(("kip", "kips", "klb", "klbf"), 1e3 * POUND_FORCE_N),
            "kgf": GRAVITY_M_PER_S2,
        },
    ),
    (
        "torque",
        "N m",
        {
            **dict.fromkeys(("N.m", "Nm"), 1.0),
            **dict.fromkeys(("mN.m", "mNm"), 1e-3),
            **dict.fromkeys(("kN.m", "kNm"), 1e3),
            **dict.fromkeys(("lbf.ft", "lb.ft", "ft.lb", "ft.lbf"), POUND_FORCE_N * FOOT_M),
            **dict.fromkeys(("lbf.in", "lb.in", "in.lb", "in.lbf"), POUND_FORCE_N * INCH_M),
        },
    ),
    (
        "pressure",
        "Pa",
        {
            "Pa": 1.0,
            "mPa": 1e-3,
            "kPa": 1e3,
            "MPa": 1e6,
            "bar": 1e5,
            "psi": POUND_FORCE_N / INCH_M**2,
        },
    ),
    (ELECTRICAL, "V", {"V": 1.0, "mV": 1e-3, "uV": 1e-6, "volt": 1.0, "volts": 1.0}),
    ("current", "A", {"A": 1.0, "mA": 1e-3}),
    ("power", "W", {"W": 1.0, "kW": 1e3}),
    ("angle", "rad", {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180, "rev": 2 * math.pi}),
    ("angular_velocity", "rad/s", {"rad/s": 1.0, "deg/s": math.pi / 180}),
    ("angular_acceleration", "rad/s^2", {"rad/s^2": 1.0, "rad/s2": 1.0}),
    ("rotational_speed", "Hz", dict.fromkeys(("rpm", "r/min", "rev/min", "1/min", "min^-1"), 1 / 60)),
    ("", "Hz", {"Hz": 1.0, "kHz": 1e3, "rev/s": 1.0}),
    ("time", "s", {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}),
    ("temperature", "K", {"K": 1.0}),
    ("stiffness", "N/m", {"N/m": 1.0, "N/mm": 1e3, "N/um": 1e6}),
    ("strain", "1", {"strain": 1.0, "m/m": 1.0, "um/m": 1e-6, "ustrain": 1e-6, "microstrain": 1e-6}),
    ("", "1", {"1": 1.0, "dimensionless": 1.0, "%": 1e-2}),
    ("", UNCALIBRATED, dict.fromkeys((UNCALIBRATED, "arbitrary", "a.u", "counts", "FS", "full.scale"), 1.0)),
)

UNITS: Mapping[str, Unit] = MappingProxyType(
    {
        **{
            text: Unit(si=si, factor=factor, quantity=quantity)
            for quantity, si, factors in _FACTORS
            for text, factor in factors.items()
        },
        "degC": Unit(si="K", factor=1.0, offset=273.15, quantity="temperature"),
        "degF": Unit(si="K", factor=5 / 9, offset=273.15 - 32 * 5 / 9, quantity="temperature"),
    }
)
"""By normalised text (`normal`)."""

_SPELLED = str.maketrans({"²": "^2", "³": "^3", "µ": "u", "μ": "u", "·": ".", "⋅": ".", "*": ".", "−": "-"})
_TIDY = ((re.compile(r"\.{2,}"), "^"), (re.compile(r"\s*([/.^])\s*"), r"\1"), (re.compile(r"\s+"), "."))
_WORDS = {"°C": "degC", "°F": "degF", "°": "deg", "degrees": "deg"}


def normal(text: str) -> str:
    """The unit's text with one spelling: `m/s²`, `m / s**2` and `m/s^2` are the same; `µm`, `μm` are `um`."""
    tidy = text.strip().strip("[]()").strip()
    tidy = _WORDS.get(tidy, tidy).translate(_SPELLED)
    for pattern, replacement in _TIDY:
        tidy = pattern.sub(replacement, tidy)
    return tidy.rstrip(".")


def find_unit(text: str) -> Unit | None:
    """The unit, None when it is not in the table. Upper and lower case differ, as in SI."""
    return UNITS.get(normal(text))


def units_of(quantity: str) -> tuple[str, ...]:
    """The units of a quantity in one spelling each, the first of every factor; none of what has no table."""
    first: dict[float, str] = {}
    for text, unit in UNITS.items():
        if unit.quantity == quantity:
            first.setdefault(unit.factor, text)
    return tuple(first.values())


def unit_of(text: str, field: str) -> Unit:
    """The unit; SpecError when it is not in the table."""
    found = find_unit(text)
    if found is not None:
        return found
    meant = next((one for one in UNITS if one.casefold() == normal(text).casefold()), None)
    guess = "" if meant is None else f" (did you mean {meant}?)"
    message = f"unknown unit is refused, never guessed ('1': dimensionless, '{UNCALIBRATED}': scale not known){guess}"
    known = "g, m/s^2, mm/s, m/s, in/s, m, mm, um, mil, in, N, kN, lbf, N m, Pa, V, mV, A, rad, deg, rpm, Hz, 1 ..."
    raise SpecError(Problem(field=field, message=message, given=text[:80], allowed=known))
