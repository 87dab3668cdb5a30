"""Tip relief: metal taken from the tips of all teeth of a gear, so that loaded neighbours enter without a shock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec, TorqueLoad, TransmissionError
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.gear.flank import Flank
from sim.parts.mesh_shapes import Shape, every_tooth_lines, with_shape


def relief_m(from_tip: FloatArray, amount_m: float, length: float, form: float) -> FloatArray:
    """Metal missing: `amount_m` at the tip, nothing beyond `length` from it; form 1 linear, 2 parabolic."""
    return np.asarray(amount_m * np.clip(1.0 - from_tip / length, 0.0, 1.0) ** form)


def _suited(machine: MachineSpec) -> MachineSpec:
    """Loaded as the default relief is made for: teeth that bend by about that much, and no other error."""
    exact = TransmissionError(amplitude_m=0.0)
    meshes = [mesh.model_copy(update={"transmission_error": exact}) for mesh in machine.meshes]
    return machine.model_copy(update={"meshes": meshes, "loads": [TorqueLoad(shaft="input", torque_nm=60.0)]})


@dataclass(frozen=True, kw_only=True)
class TipRelief(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Add the relief to every tooth."""

        def make(flank: Flank) -> Shape:
            return 0.0, relief_m(flank.from_tip, values["amount"], values["length"], values["form"])

        return with_shape(laws, site, self.key, make)

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Every tooth alike: mesh harmonics only."""
        return every_tooth_lines(site, self.key) if values["amount"] > 0.0 else ()


TERM = TipRelief(
    key="tip_relief",
    title="Tip relief",
    sentence="The tips of all teeth stand back a little, so that they enter the mesh without a shock.",
    sites=("gear",),
    params=(
        Param(
            name="amount",
            unit="m",
            default=1e-5,
            low=0.0,
            high=1e-4,
            sentence="Metal taken off at the tip circle, along the line of action.",
            scale="log",
        ),
        Param(
            name="length",
            unit="1",
            default=0.3,
            low=0.05,
            high=0.5,
            sentence="Length of the relief as a share of the path of contact.",
        ),
        Param(
            name="form",
            unit="1",
            default=1.0,
            low=1.0,
            high=2.0,
            sentence="1: linear from its start to the tip; 2: parabolic.",
            choices=(1.0, 2.0),
        ),
    ),
    references=("ISO 21771:2007 (profile modifications)",),
    severity="amount",
    order=20,
    demo=Demo(
        machine="gear-pair",
        elsewhere=("gear",),
        leading=3,
        falls=True,
        prepare=_suited,
        note="At 60 N m, for which the default relief of both gears is made, with teeth otherwise exact.",
    ),
    validation=(
        Validation(
            kind="independent calculation",
            source="static transmission error: load balance of the pairs in contact solved by bisection with NumPy",
            deviation=5e-3,
            test="tests/sim/terms/test_profile.py::test_static_transmission_error",
        ),
    ),
)
