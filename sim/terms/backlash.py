"""Backlash: the flanks may part, and the back flanks may touch; adds to what the mesh already has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.spec import MachineSpec, TorqueLoad
from sim.core.terms import Demo, SiteContext, Term, Validation, Values


@dataclass(frozen=True, kw_only=True)
class Backlash(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Widen the backlash of this mesh, or give it one."""
        law = laws.meshes[site.site]
        if values["width"] == 0.0:
            return laws
        wider = replace(law, backlash_m=(law.backlash_m or 0.0) + values["width"])
        return replace(laws, meshes={**laws.meshes, site.site: wider})

    def faint(self, values: Values) -> None:  # noqa: ARG002
        """Next to no play is still two flanks, where a mesh without play holds its flanks together."""
        return

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Harmonics of the mesh: parting and striking is far from sinusoidal."""
        if values["width"] == 0.0:
            return ()
        base = "f_m" if site.index == 1 else f"f_m{site.index}"
        return tuple(
            Line(orders=((base, k),), component=site.site, mechanism=self.key, family="mesh") for k in range(2, 10)
        )


def lightly_loaded(machine: MachineSpec) -> MachineSpec:
    """The machine with a torque too small to keep the flanks together; front and back strike once a period."""
    loads = [TorqueLoad(shaft="input", torque_nm=0.1)]
    operating = machine.operating
    if operating is not None:
        operating = operating.model_copy(update={"speed_hz": 20.0})
    return machine.model_copy(update={"loads": loads, "operating": operating})


TERM = Backlash(
    key="backlash",
    title="Backlash",
    sentence="The teeth have play: under little load they part, and strike with front and back flanks.",
    sites=("mesh",),
    params=(
        Param(
            name="width",
            unit="m",
            default=5e-5,
            low=0.0,
            high=1e-3,
            sentence="Play along the line of action, added to what the mesh has.",
            scale="log",
        ),
    ),
    references=(
        "Comparin & Singh 1989, J. Sound Vib. 134(2), 259-290 (impact pairs with backlash)",
        "Hunt & Crossley 1975, J. Appl. Mech. 42(2), 440-445 (damping of a contact vanishes at touch)",
    ),
    severity="width",
    order=20,
    demo=Demo(
        machine="gear-pair",
        prepare=lightly_loaded,
        note="At 20 Hz with 0.1 N m, too little to keep the flanks together.",
        leading=2,
    ),
    validation=(
        Validation(
            kind="closed form",
            source="piecewise linear force: drive flank, play, back flank",
            deviation=1e-9,
            test="tests/sim/terms/test_backlash.py::test_force_over_deflection_has_a_dead_zone",
        ),
        Validation(
            kind="closed form",
            source="speed kept in a strike without damper, at steps of 15 and 60 kHz",
            deviation=2e-4,
            test="tests/sim/terms/test_backlash.py::test_a_strike_without_damper_gives_back_the_speed",
        ),
    ),
)
