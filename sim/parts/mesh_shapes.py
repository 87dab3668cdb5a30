"""Shapes of damaged or modified teeth added to the mesh laws of a gear, and the lines that one odd tooth makes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from sim.core.errors import Problem, SpecError
from sim.core.laws import TOOTH_POINTS, Laws, MeshLaw
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.core.terms import SiteContext
from sim.parts.gear.flank import Flank, flank_of

Shape = tuple[FloatArray | float, FloatArray | float]
"""Compliance gained (m/N) and metal missing (m) over the path of contact."""

PLACE = Param(
    name="place",
    unit="1",
    default=0.0,
    low=0.0,
    high=0.999,
    sentence="Which tooth: share of a turn from tooth 0, rounded down to a whole tooth.",
)


def needs_pairs(law: MeshLaw, machine: MachineSpec, key: str) -> None:
    """SpecError where a mesh is one curve, in which no single tooth can be told, or where contact lines are oblique."""
    if law.pair_rows is None:
        message = f"{key} acts on single tooth pairs, and this mesh is given by one total stiffness curve"
        mesh = next(m for m in machine.meshes if m.name == law.name)
        if mesh.table is not None:
            field, allowed = f"meshes.{law.name}.table", "null, with tooth_pairs true"
            raise SpecError(Problem(field=field, message=message, given="a table", allowed=allowed))
        field, allowed = f"meshes.{law.name}.tooth_pairs", "true"
        raise SpecError(Problem(field=field, message=message, given=mesh.tooth_pairs, allowed=allowed))
    helix = next(g.helix_angle_deg for g in machine.gears if g.name == law.pinion)
    if helix != 0.0:
        message = f"{key} knows the contact of spur gears only: on helical ones it runs obliquely over the flank"
        field = f"gears.{law.pinion}.helix_angle_deg"
        raise SpecError(Problem(field=field, message=message, given=helix, allowed="0", unit="deg"))


def loaded_flank(law: MeshLaw, gear: str) -> float:
    """+1 where a gear's leading flanks carry the load, -1 where its trailing ones do."""
    return law.drive if law.pinion == gear else -law.drive


def damaged_tooth(place: float, teeth: int) -> slice:
    """The tooth that stands a share of a turn behind tooth 0."""
    tooth = int(place * teeth + 1e-9)
    return slice(tooth, tooth + 1)


def _added(law: MeshLaw, gear: str, teeth: slice, shape: Shape) -> MeshLaw:
    driving = law.pinion == gear
    count = law.teeth[0] if driving else law.teeth[1]
    before = law.pinion_shape if driving else law.gear_shape
    rows = np.zeros((count, 2, TOOTH_POINTS)) if before is None else before.copy()
    rows[teeth, 0] += shape[0]
    rows[teeth, 1] += shape[1]
    return replace(law, pinion_shape=rows) if driving else replace(law, gear_shape=rows)


def with_shape(
    laws: Laws,
    site: SiteContext,
    key: str,
    make: Callable[[Flank], Shape],
    *,
    place: float | None = None,
    one_flank: bool = False,
) -> Laws:
    """Add a shape to one tooth of the gear at `site` (all teeth without a place) in every mesh it takes part in.

    `one_flank`: the damage is on the flank that the first of these meshes loads, and acts in the meshes that load it.
    """
    meshes = dict(laws.meshes)
    mine = [law for law in laws.meshes.values() if site.site in (law.pinion, law.gear)]
    for law in mine:
        needs_pairs(law, site.machine, key)
        if one_flank and loaded_flank(law, site.site) != loaded_flank(mine[0], site.site):
            continue
        count = law.teeth[0] if law.pinion == site.site else law.teeth[1]
        teeth = slice(0, count) if place is None else damaged_tooth(place, count)
        meshes[law.name] = _added(law, site.site, teeth, make(flank_of(site.machine, law.name, site.site)))
    return replace(laws, meshes=meshes)


def mesh_bases(site: SiteContext) -> list[str]:
    """Base names of the meshes a gear takes part in."""
    found = []
    for i, mesh in enumerate(site.machine.meshes, 1):
        if site.site in (mesh.pinion, mesh.gear):
            found.append("f_m" if i == 1 else f"f_m{i}")
    return found


def odd_tooth_lines(site: SiteContext, key: str) -> tuple[Line, ...]:
    """Multiples of the shaft speed, since one tooth strikes once a turn, and sidebands of the mesh harmonics."""
    if not site.shaft_base or not mesh_bases(site):
        return ()
    found = [
        Line(orders=((site.shaft_base, k),), component=site.site, mechanism=key, family="shaft") for k in range(1, 11)
    ]
    for base in mesh_bases(site):
        for k in range(1, 5):
            for side in (-3, -2, -1, 1, 2, 3):
                orders = ((base, k), (site.shaft_base, side))
                found.append(Line(orders=orders, component=site.site, mechanism=key, family="mesh"))
    return tuple(found)


def every_tooth_lines(site: SiteContext, key: str) -> tuple[Line, ...]:
    """Multiples of the mesh frequency: what all teeth have alike."""
    return tuple(
        Line(orders=((base, k),), component=site.site, mechanism=key, family="mesh")
        for base in mesh_bases(site)
        for k in range(1, 8)
    )
