"""Tooth friction: Coulomb friction of the flanks, which reverses at the pitch point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sim.core.elements import Element
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.spec import MachineSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.mesh_shapes import needs_pairs
from sim.parts.tooth_forces import Friction, tooth_force_element


@dataclass(frozen=True, kw_only=True)
class ToothFriction(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:
        """Friction of every pair, on both gears."""
        law = laws.meshes[site.site]
        needs_pairs(law, site.machine, self.key)
        friction = Friction(coefficient=values["coefficient"], speed_m_per_s=values["speed"])
        element = tooth_force_element(
            law,
            site.machine,
            name=f"{site.site}.friction",
            friction=friction,
            tilting=False,
            speed_hz=site.speed_hz,
        )
        return (element,)

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Multiples of the mesh frequency: every pair passes the pitch point once."""
        if values["coefficient"] == 0.0:
            return ()
        base = "f_m" if site.index == 1 else f"f_m{site.index}"
        return tuple(
            Line(orders=((base, k),), component=site.site, mechanism=self.key, family="mesh") for k in range(1, 8)
        )


def felt_along_x(machine: MachineSpec) -> MachineSpec:
    """The machine with its sensors across the line of action, where the tooth loads themselves do not reach."""
    turned = [r.model_copy(update={"axis": "x"}) for r in machine.resonators]
    return machine.model_copy(update={"resonators": turned})


TERM = ToothFriction(
    key="tooth_friction",
    title="Tooth friction",
    sentence="The flanks slide on each other, and the friction reverses where the contact passes the pitch point.",
    sites=("mesh",),
    params=(
        Param(
            name="coefficient",
            unit="1",
            default=0.05,
            low=0.0,
            high=0.3,
            sentence="Coefficient of friction of the flanks.",
        ),
        Param(
            name="speed",
            unit="m/s",
            default=0.05,
            low=0.01,
            high=1.0,
            sentence="Sliding speed at which friction reaches tanh(1) = 76 % of its full value.",
            scale="log",
        ),
    ),
    references=(
        "Vaishya & Singh 2001, J. Sound Vib. 248(4), 671-694 (sliding friction in spur gear dynamics)",
        "Niemann & Winter, Maschinenelemente vol. 2, 2nd ed. 2003 (loss factor after Ohlendorf)",
    ),
    severity="coefficient",
    order=20,
    demo=Demo(prepare=felt_along_x, note="With its sensors turned to x, across the line of action."),
    validation=(
        Validation(
            kind="closed form",
            source="forces and torques worked out as vectors at the contact points; reversal at the pitch point",
            deviation=1e-4,
            test="tests/sim/terms/test_tooth_friction.py::test_forces_and_torques_of_vectors",
        ),
        Validation(
            kind="closed form",
            source="loss factor pi (1/z1 + 1/z2)(1 - eps + eps1^2 + eps2^2) for equally shared load (Ohlendorf)",
            deviation=0.05,
            test="tests/sim/terms/test_tooth_friction.py::test_loss_agrees_with_the_loss_factor",
        ),
        Validation(
            kind="independent calculation",
            source="loss of a static load, shared as the pairs' stiffnesses, by quadrature over a mesh period",
            deviation=0.01,
            test="tests/sim/terms/test_tooth_friction.py::test_loss_agrees_with_a_quadrature_over_the_mesh_period",
        ),
    ),
)
