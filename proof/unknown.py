"""Physics that no library has: the engine must say so, and find where it acts."""

from __future__ import annotations

from collections.abc import Mapping

from proof.effects import BEARINGS, GEARS, SHAFTS, Apply, Choice, Law
from proof.machine import Arrays
from proof.model.layout import B, X


def _pull(a: Arrays, c: Choice) -> None:
    a.x[X.PULL], a.x[X.PULL_SWING], a.x[X.PULL_AT] = c.value, c.rng.uniform(0.5, 0.9), float(c.site)


def _belt(a: Arrays, c: Choice) -> None:
    a.x[X.BELT_SHARE], a.x[X.BELT_RATIO] = c.value, c.rng.uniform(0.28, 0.43)
    a.x[X.BELT_FORCE] = 2000.0 * c.value


def _mains(a: Arrays, c: Choice) -> None:
    a.x[X.MAINS_TORQUE], a.x[X.MAINS_PHASE] = c.value, c.rng.uniform(-3.0, 3.0)


def _bouc(a: Arrays, c: Choice) -> None:
    b = a.bearings[c.site]
    b[B.BOUC_K], b[B.BOUC_AT], b[B.BOUC_SIGN] = c.value, c.rng.uniform(1.5e-6, 4e-6), 1.0


def _drag(a: Arrays, c: Choice) -> None:
    a.bearings[c.site][B.DRAG2], a.bearings[c.site][B.DRAG2_FROM] = c.value, 5e-3


def _dead(a: Arrays, c: Choice) -> None:
    b = a.bearings[c.site]
    b[B.DEAD_K], b[B.DEAD_WIDTH], b[B.DEAD_LAG] = c.value, c.rng.uniform(8e-6, 1.2e-5), c.rng.uniform(5e-5, 1.5e-4)


def _knock(a: Arrays, c: Choice) -> None:
    b = a.bearings[c.site]
    b[B.KNOCK], b[B.KNOCK_HZ], b[B.KNOCK_S] = c.value, c.rng.uniform(9.0, 16.0), 4e-4
    b[B.KNOCK_PHASE] = c.rng.uniform(0.0, 1.0)


def _whip(a: Arrays, c: Choice) -> None:
    a.bearings[c.site][B.WHIP], a.bearings[c.site][B.WHIP_AT] = c.value, 4e-5


def _quintic(a: Arrays, c: Choice) -> None:
    b = a.bearings[c.site]
    at = 1e-5
    b[B.CUBIC], b[B.QUINTIC] = -1.5 * c.value / at**2, 1.2 * c.value / at**4


def _law(sites: tuple[str, ...], unit: str, levels: tuple[float, float, float, float], apply: Apply) -> Law:
    return Law(sites=sites, terms=(), severity="size", unit=unit, levels=levels, apply=apply, sized=False)


OPEN: Mapping[str, Law] = {
    "magnetic_pull": _law(GEARS, "N/m", (1e6, 3e6, 8e6, 1.6e7), _pull),
    "cross_coupling": _law(BEARINGS, "N/m", (3e6, 6e6, 1.2e7, 2e7), _whip),
    "parametric_belt": _law(("input",), "1", (0.02, 0.05, 0.1, 0.2), _belt),
    "hysteretic_mount": _law(BEARINGS, "N/m", (1e7, 2e7, 4e7, 8e7), _bouc),
    "free_knocks": _law(BEARINGS, "N", (60.0, 120.0, 250.0, 500.0), _knock),
    "quadratic_drag": _law(BEARINGS, "N*s^2/m^2", (2e4, 6e4, 2e5, 5e5), _drag),
    "late_dead_band": _law(BEARINGS, "N/m", (1e7, 2e7, 4e7, 6e7), _dead),
    "softening_then_hardening": _law(BEARINGS, "N/m", (5e6, 1e7, 2e7, 4e7), _quintic),
    "line_torque": _law(SHAFTS[:1], "N*m", (1.0, 2.0, 4.0, 8.0), _mains),
}
