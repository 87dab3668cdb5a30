"""Lead misalignment: the face is cut into thin slices, and tilted flanks shift the load along the tooth width.

This is what an offset angle really acts through: angle times width is comparable with the mesh deflection. The shafts'
own tilt adds to the given angle, and the shifted load tilts the shafts in turn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sim.core.elements import Element
from sim.core.laws import Laws, MeshLaw
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.spec import MachineSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.mesh_shapes import needs_pairs
from sim.parts.tooth_forces import Friction, tooth_force_element

SLICES = 15
"""Odd, so that one stands in the middle; against the closed form the load is exact while all touch (tests)."""


def sliced(law: MeshLaw, width_m: float, angle_rad: float, backlash_m: float) -> MeshLaw:
    """The law with its face in slices; flanks that part need backlash, which a mesh without it is given."""
    return replace(
        law,
        slices=SLICES,
        face_width_m=width_m,
        lead_rad=law.lead_rad + angle_rad,
        backlash_m=backlash_m if law.backlash_m is None else law.backlash_m,
    )


@dataclass(frozen=True, kw_only=True)
class LeadMisalignment(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Cut the face into slices."""
        law = laws.meshes[site.site]
        needs_pairs(law, site.machine, self.key)
        if values["angle"] == 0.0:
            return laws
        faces = [g.face_width_m for g in site.machine.gears if g.name in (law.pinion, law.gear)]
        changed = sliced(law, min(faces), values["angle"], values["backlash"])
        return replace(laws, meshes={**laws.meshes, site.site: changed})

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """The tilting moment of the shifted load, on the ends of both shafts."""
        law = laws.meshes[site.site]
        name = f"{site.site}.tilting"
        return (tooth_force_element(law, site.machine, name=name, friction=Friction(), tilting=True),)

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Multiples of the mesh frequency: a softer mesh that follows the load."""
        if values["angle"] == 0.0:
            return ()
        base = "f_m" if site.index == 1 else f"f_m{site.index}"
        return tuple(
            Line(orders=((base, k),), component=site.site, mechanism=self.key, family="mesh") for k in range(1, 8)
        )


def exact_teeth(machine: MachineSpec) -> MachineSpec:
    """The machine without its transmission error, whose line at the mesh frequency covers all others."""
    error = {"transmission_error": {"amplitude_m": 0.0}}
    return MachineSpec.model_validate(
        {**machine.model_dump(), "meshes": [{**mesh.model_dump(), **error} for mesh in machine.meshes]}
    )


TERM = LeadMisalignment(
    key="lead_misalignment",
    title="Lead misalignment",
    sentence="The teeth touch at an angle, so one end of their width carries more than the other.",
    sites=("mesh",),
    params=(
        Param(
            name="angle",
            unit="rad",
            default=3e-4,
            low=-3e-3,
            high=3e-3,
            sentence="Angle between the flanks in the plane of action, without load.",
        ),
        Param(
            name="backlash",
            unit="m",
            default=1e-4,
            low=2e-5,
            high=1e-3,
            sentence="Backlash where the mesh has none: flanks that touch on part of their width must be able to part.",
            scale="log",
        ),
    ),
    references=(
        "ISO 6336-1:2006 (face load factor of a linear misalignment)",
        "Ajmi & Velex 2005, Mech. Mach. Theory 40(2), 173-190 (slices along the face)",
    ),
    severity="angle",
    order=30,
    demo=Demo(values={"angle": 1e-3}, prepare=exact_teeth, note="Without its transmission error."),
    validation=(
        Validation(
            kind="closed form",
            source="wedge on a bed of springs: load, contact width, load at the edge and moment",
            deviation=0.02,
            test="tests/sim/terms/test_lead_misalignment.py::test_load_of_a_wedge_on_a_bed_of_springs",
        ),
    ),
)
