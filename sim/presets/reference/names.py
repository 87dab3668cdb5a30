"""The parameter names of a reference file, each declared once: unit, bounds, meaning, and what its absence means."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean
from sim.core.params import Param

Absence = Literal["refused", "derived", "default"]


@dataclass(frozen=True, kw_only=True)
class Key(Param):
    """A parameter of the file. When it is absent it is refused, derived from the others, or `default` is taken."""

    absence: Absence = "refused"
    whole: bool = False


def _need(name: str, unit: str, low: float, high: float, sentence: str, *, whole: bool = False) -> Key:
    return Key(name=name, unit=unit, default=low, low=low, high=high, sentence=sentence, whole=whole)


def _default(name: str, unit: str, default: float, low: float, high: float, sentence: str) -> Key:
    return Key(name=name, unit=unit, default=default, low=low, high=high, sentence=sentence, absence="default")


def _derived(name: str, unit: str, low: float, high: float, sentence: str) -> Key:
    return Key(name=name, unit=unit, default=low, low=low, high=high, sentence=sentence, absence="derived")


TINY = 1e-12
"""Least inertia, kg m^2; the specification has the same bounds."""
_KEYS = (
    _need("If1", "kg*m^2", TINY, 1e4, "Inertia at the input end."),
    _need("Ip", "kg*m^2", TINY, 1e5, "Inertia of the pinion."),
    _need("Ig", "kg*m^2", TINY, 1e5, "Inertia of the gear."),
    _need("If2", "kg*m^2", TINY, 1e4, "Inertia at the output end."),
    _need("mp_", "kg", 1e-6, 1e5, "Mass of the pinion."),
    _need("mg", "kg", 1e-6, 1e5, "Mass of the gear."),
    _need("kf", "N*m/rad", 1e-6, 1e10, "Torsional stiffness of each shaft."),
    _need("cf", "N*m*s/rad", 0, 1e8, "Torsional damping of each shaft."),
    _need("ks", "N/m", 1e-3, 1e13, "Stiffness between gear and inner ring."),
    _need("cs", "N*s/m", 0, 1e9, "Damping between gear and inner ring."),
    _need("kp", "N/m", 0, 1e13, "Support stiffness of an outer ring."),
    _need("cp", "N*s/m", 0, 1e9, "Support damping of an outer ring."),
    _need("kr", "N/m", 1e-3, 1e13, "Stiffness of a resonator."),
    _need("cr", "N*s/m", 0, 1e9, "Damping of a resonator."),
    _need("ms", "kg", 1e-6, 1e4, "Mass of an inner ring."),
    _need("mo", "kg", 1e-6, 1e4, "Mass of an outer ring."),
    _need("mr", "kg", 1e-6, 1e4, "Mass of a resonator."),
    _derived("kre", "N/m^1.5", 1e-3, 1e13, "Ball-race stiffness; absent: Hertz contact, if ball diameters are given."),
    _default("c0", "m", 0.0, -1e-4, 1e-3, "Internal clearance of the balls."),
    _default("e0", "m", 0.0, -1e-3, 1e-3, "Mean transmission error."),
    _default("em", "m", 0.0, 0.0, 1e-3, "Amplitude of the transmission error."),
    _default("phi", "rad", 0.0, -1e3, 1e3, "Phase of the transmission error."),
    _default("zeta_m", "1", 0.05, 0.0, 2.0, "Mesh damping ratio, used when ct is absent."),
    _derived("ct", "N*s/m", 0, 1e8, "Mesh damping; absent: 2 zeta_m sqrt(mean stiffness * equivalent mass)."),
    _default("cN", "N*s/m", 2e3, 0, 1e6, "Damping of the wall."),
    _default("mu", "1", 0.1, 0, 1, "Friction of the wall."),
    _default("L2", "mm", 15.0, 1, 500, "Width of the ring in its bore."),
    _need("fr1", "Hz", 0.1, 1000, "Speed of the input shaft."),
    _need("T", "N*m", -1e7, 1e7, "Torque on the input shaft."),
    _derived("Tout", "N*m", -1e8, 1e8, "Torque taken from the output shaft; absent: in balance with T."),
    _need("z1", "1", 6, 2000, "Teeth of the pinion.", whole=True),
    _need("z2", "1", 6, 2000, "Teeth of the gear.", whole=True),
    _need("m", "m", 1e-4, 0.1, "Module."),
    _need("W", "m", 1e-4, 2, "Face width."),
    _need("al", "deg", 10, 35, "Pressure angle."),
    _derived("nb1", "1", 3, 64, "Balls of bearings 1 and 2; absent: from `bearings`."),
    _derived("g1", "1", 1e-3, 0.9, "Ball over pitch diameter of bearings 1 and 2; absent: from `bearings`."),
    _derived("nb2", "1", 3, 64, "Balls of bearings 3 and 4; absent: from `bearings`."),
    _derived("g2", "1", 1e-3, 0.9, "Ball over pitch diameter of bearings 3 and 4; absent: from `bearings`."),
    _default("delta", "m", 0.0, 0.0, 5e-4, "Fit clearance of bearing 1; 0: the ring is held by its support."),
    _default("gravity", "m/s^2", 0.0, 0.0, 100.0, "Gravity along -y."),
    _default("L", "m", 0.26, 1e-3, 20, "Length of a shaft (used by the offset angle only)."),
    _derived("Rb_pin", "m", 1e-5, 100, "Base radius of the pinion; absent: m z1 cos(al) / 2."),
    _derived("Rb_ge", "m", 1e-5, 100, "Base radius of the gear; absent: m z2 cos(al) / 2."),
    _derived("fm", "Hz", 1e-3, 1e6, "Mesh frequency; absent: z1 fr1."),
    _derived("fr2", "Hz", 1e-4, 1e5, "Speed of the output shaft; absent: fr1 z1 / z2."),
    _derived("a0", "m", 1e-4, 50, "Installed centre distance; absent: m (z1 + z2) / 2."),
    _default("ecc_pinion", "m", 0.0, 0.0, 5e-4, "Run-out radius of the pinion."),
    _default("ecc_gear", "m", 0.0, 0.0, 5e-4, "Run-out radius of the gear."),
    _default("unbalance_pinion", "kg*m", 0.0, 0.0, 0.1, "Unbalance of the pinion, mass times radius."),
    _default("unbalance_gear", "kg*m", 0.0, 0.0, 0.1, "Unbalance of the gear, mass times radius."),
    _default("pitch_error_rms", "m", 0.0, 0.0, 1e-4, "RMS of the pinion's tooth deviations."),
    _default("cage_slip", "1", 0.0, 0.0, 0.5, "Share of cage speed lost, every bearing."),
)
KEYS: Mapping[str, Key] = {key.name: key for key in _KEYS}
"""Every name a reference file may use."""


def checked(given: Mapping[str, object]) -> dict[str, float]:
    """The given numbers; SpecError names every unknown key, every wrong value and every missing key at once."""
    problems = [_unknown(name) for name in given if name not in KEYS]
    values: dict[str, float] = {}
    for name, value in given.items():
        if name in KEYS:
            problem = _wrong(KEYS[name], value)
            problems += [problem] if problem else []
            if problem is None and isinstance(value, int | float):
                values[name] = float(value)
    problems += [
        Problem(
            field=f"parameters.{key.name}",
            message=f"is missing: {key.sentence.rstrip('.')}",
            unit=key.unit,
            allowed=f"{'a whole number, ' if key.whole else ''}{key.low:g} to {key.high:g}",
        )
        for key in KEYS.values()
        if key.absence == "refused" and key.name not in given
    ]
    if problems:
        raise SpecError(problems)
    return values


def _unknown(name: str) -> Problem:
    return Problem(
        field=f"parameters.{name}",
        message=f"is not a known parameter{did_you_mean(name, KEYS)}",
        given=name,
        allowed=", ".join(KEYS),
    )


def _wrong(key: Key, value: object) -> Problem | None:
    field = f"parameters.{key.name}"
    problem = key.problem(value, field)
    if problem is not None and key.unit == "Hz" and _as_rpm(key, value):
        return replace(
            problem, message=f"{problem.message} (it would fit as rpm: speeds are in revolutions per second)"
        )
    if problem is None and (key.whole or key.name in ("nb1", "nb2")) and float(value) % 1 != 0:  # type: ignore[arg-type]
        return Problem(field=field, message="must be a whole number", given=value, allowed="a whole number")
    return problem


def _as_rpm(key: Key, value: object) -> bool:
    """Whether a number is too large for a speed and would not be in rpm."""
    return isinstance(value, int | float) and not isinstance(value, bool) and key.high < value <= 60.0 * key.high
