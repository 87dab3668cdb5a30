"""What an effect changes in a machine, as pictures: whatever differs between the two machines is put on the bench."""

from __future__ import annotations

from dataclasses import replace

from sim.core.spec import MachineSpec
from sim.solve.law_picture.ball_panels import ball_panels
from sim.solve.law_picture.element_panels import element_panels
from sim.solve.law_picture.linear_panels import mass_panels, weight_panel
from sim.solve.law_picture.mesh_panels import mesh_panels
from sim.solve.law_picture.panel import Panel
from sim.solve.law_picture.side import Side, differ, side

MOST = 4


def law_picture(machine: MachineSpec, without: MachineSpec, *, site: str = "") -> tuple[Panel, ...]:
    """Pictures of what `machine` has and `without` has not; `site` is where the effect acts. None when they are alike.

    What every machine has is shown by `built_in_picture`.
    """
    here, before = side(machine), side(without)
    found = _elements(here, before, site)
    known = {mass.name for mass in before.laws.masses}
    for mass in here.laws.masses:
        if mass.name not in known:
            found += mass_panels(here, mass)
    if len(here.laws.weights) > len(before.laws.weights):
        found.append(weight_panel(here, before, site))
    return tuple(panel for panel in found if panel.telling)[:MOST]


def built_in_picture(machine: MachineSpec, kind: str) -> tuple[Panel, ...]:
    """Pictures of what every machine has of a kind: `mesh`, `bearing` or `load`; its first one."""
    here = side(machine)
    if kind == "mesh":
        name = machine.meshes[0].name
        return tuple(mesh_panels(here, None, name, ""))
    if kind == "bearing":
        return tuple(ball_panels(here, None, machine.bearings[0].name))
    element = next(e for e in here.system.elements if e.name.startswith("load"))
    return tuple(_alone(panel) for panel in element_panels(here, here, element))


def _alone(panel: Panel) -> Panel:
    """A picture with nothing to compare with."""
    return replace(panel, curves=tuple(replace(curve, without=None) for curve in panel.curves))


def _elements(here: Side, before: Side, site: str) -> list[Panel]:
    found: list[Panel] = []
    others = before.elements
    for element in here.system.elements:
        other = others.get(element.name)
        if other is not None and not differ(element, other):
            continue
        if element.name in here.laws.meshes and other is not None:
            found += mesh_panels(here, before, element.name, site)
        elif element.name in here.laws.balls and other is not None:
            found += ball_panels(here, before, element.name)
        else:
            found += element_panels(here, before, element)
    return found
