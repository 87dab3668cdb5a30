"""Where a site is held: its spring to ground along x or y, or the mounts of the sensors on a bearing's ring."""

from __future__ import annotations

from dataclasses import dataclass

from sim.core.laws import Laws
from sim.core.spec import MachineSpec
from sim.core.terms import SiteContext
from sim.parts.rotor import refusal

ALONG_X, ALONG_Y, SENSOR = 0.0, 1.0, 2.0


@dataclass(frozen=True, kw_only=True)
class Joint:
    """Displacement of a part against what holds it, m: weights by degree of freedom."""

    part: str
    axis: str
    weights: tuple[tuple[str, float], ...]


def _axes(machine: MachineSpec, name: str) -> str:
    """Axes along which a gear or body moves."""
    if any(g.name == name and g.translates for g in machine.gears):
        return "xy"
    return next((b.axes for b in machine.bodies if b.name == name), "")


def _mounts(site: SiteContext, key: str) -> tuple[Joint, ...]:
    found = [r for r in site.machine.resonators if r.bearing == site.site]
    if not found:
        raise refusal(site, key, "no sensor sits on it", "a bearing with a resonator, or a direction, 0 or 1")
    return tuple(
        Joint(part=r.name, axis=r.axis, weights=((f"{r.name}.{r.axis}", 1.0), (f"{site.site}.outer.{r.axis}", -1.0)))
        for r in found
    )


def joints(laws: Laws, which: float, site: SiteContext, key: str) -> tuple[Joint, ...]:
    """What is meant at a bearing, gear or body by `which`; SpecError where it has none of that.

    A bearing is held at its housing where that has a mass of its own, else at its outer ring.
    """
    at = site.site
    if which == SENSOR:
        return _mounts(site, key)
    axis = "x" if which == ALONG_X else "y"
    if at in laws.supports:
        if laws.supports[at].released:
            raise refusal(site, key, "its ring has lost its support", "a bearing without fit_clearance, or a sensor, 2")
        seat = "housing" if laws.supports[at].housing_mass_kg > 0.0 else "outer"
        return (Joint(part=at, axis=axis, weights=((f"{at}.{seat}.{axis}", 1.0),)),)
    if axis not in _axes(site.machine, at):
        raise refusal(site, key, f"it does not move along {axis}", f"a body that moves along {axis}")
    return (Joint(part=at, axis=axis, weights=((f"{at}.{axis}", 1.0),)),)
