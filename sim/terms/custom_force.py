"""A force law of the user's own, from the machine's `custom_laws`: an expression or a table over (x, v, phi).

It acts between two degrees of freedom, or one and the ground, with the angle of the site's shaft.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.errors import Problem, SpecError
from sim.core.expression import MAX_INSTRUCTIONS, TABLE, Instruction, Program, compiled
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.response import FloatArray
from sim.core.spec import CustomLaw, ForceTable, MachineSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.law_at_rest import forces_at_rest
from sim.parts.program_kernel import CONTEXT, KERNEL
from sim.parts.rotor import shaft_lines


def program_of(law: CustomLaw, number: int) -> Program:
    """The steps of a law; SpecError says what its expression must change."""
    if law.expression is None:
        return (Instruction(code=TABLE),)
    return compiled(law.expression, f"custom_laws.{number - 1}.expression")


def _inverse_step(ends: Sequence[float], count: int) -> float:
    return (count - 1) / (ends[1] - ends[0])


def table_parameters(table: ForceTable | None) -> FloatArray:
    """Head and values as the kernel reads them."""
    if table is None:
        return np.zeros(7)
    return flat(
        float(table.displacements),
        float(table.velocities),
        float(table.angles),
        table.displacement[0],
        _inverse_step(table.displacement, table.displacements),
        table.velocity[0],
        _inverse_step(table.velocity, table.velocities),
        np.array(table.force),
    )


def law_parameters(law: CustomLaw, number: int, scale: float) -> FloatArray:
    """Flat parameter array of one law."""
    program = program_of(law, number)
    codes, values = np.zeros(MAX_INSTRUCTIONS), np.zeros(MAX_INSTRUCTIONS)
    codes[: len(program)] = [step.code for step in program]
    values[: len(program)] = [step.value for step in program]
    return flat(float(len(program)), codes, values, scale, table_parameters(law.table))


MOST_N = 1e9
"""Force (moment) at rest above which a law cannot be meant: the thrust of a hundred moon rockets, on one part."""


def checked_at_rest(law: CustomLaw, number: int, parameters: FloatArray) -> FloatArray:
    """The parameters; SpecError names a law whose force is no number, or beyond reason, before anything moves."""
    worst = forces_at_rest(parameters)
    worst = worst[np.argmax(np.where(np.isfinite(worst), np.abs(worst), np.inf))]
    if np.isfinite(worst) and abs(worst) <= MOST_N:
        return parameters
    form = "table" if law.expression is None else "expression"
    message = f"the force of law {law.name!r} at rest (x = v = 0) is {worst:.3g}: is something divided by zero?"
    given = law.expression if law.expression is not None else float(worst)
    allowed = f"-{MOST_N:g} to {MOST_N:g} at x = v = 0"
    field = f"custom_laws.{number - 1}.{form}"
    raise SpecError(Problem(field=field, message=message, given=given, allowed=allowed, unit="N"))


def _demonstration(machine: MachineSpec) -> MachineSpec:
    """A spring between ring and ground that is stiffer on one side of the shaft's turn."""
    law = CustomLaw(name="once_a_turn", dof="bearing1.outer.y", expression="50*cos(phi)+20*cos(2*phi)")
    return machine.model_copy(update={"custom_laws": [law]})


@dataclass(frozen=True, kw_only=True)
class CustomForce(Term):
    """See the module."""

    def values(self, given: Values, where: str) -> dict[str, float]:
        """Fill defaults; laws are numbered from 1."""
        found = super().values(given, where)
        if found["law"] != round(found["law"]):
            message = "must be a whole number: the place of the law in custom_laws, from 1"
            raise SpecError(Problem(field=f"{where}.law", message=message, given=found["law"], allowed="1 to 64"))
        return found

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """One element a law."""
        number, known = int(values["law"]), site.machine.custom_laws
        if number > len(known):
            message = "custom_force names a law that the machine does not have"
            allowed = f"1 to {len(known)}" if known else "a machine with custom_laws"
            raise SpecError(Problem(field="custom_laws", message=message, given=number, allowed=allowed))
        law = known[number - 1]
        turning = law.dof.endswith(".theta")
        weights = ((law.dof, 1.0),) if law.against is None else ((law.dof, 1.0), (law.against, -1.0))
        name = f"{site.site}.custom.{law.name}"
        output = Output(
            name="force",
            quantity="torque" if turning else "force",
            unit="N*m" if turning else "N",
            axis=law.dof.rsplit(".", 1)[1],
        )
        return (
            Element(
                name=name,
                site=site.site,
                kernel=KERNEL,
                coordinates=(Coordinate(name=name, unit="rad" if turning else "m", weights=weights),),
                forces=1,
                parameters=checked_at_rest(law, number, law_parameters(law, number, values["scale"])),
                context=CONTEXT,
                shafts=(site.shaft, site.shaft),
                outputs=(output,),
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """The shaft's rotation and its double, where the law follows the shaft's angle."""
        number = int(values["law"])
        if values["scale"] == 0.0 or number > len(site.machine.custom_laws):
            return ()
        law = site.machine.custom_laws[number - 1]
        follows = law.table.angles > 1 if law.table is not None else "phi" in (law.expression or "")
        return shaft_lines(site, self.key, (1, 2)) if follows else ()


TERM = CustomForce(
    key="custom_force",
    title="Force law of one's own",
    sentence="A force that the user gives as a formula or table of displacement, velocity and shaft angle.",
    sites=("bearing", "gear", "body", "mesh", "shaft"),
    params=(
        Param(
            name="law",
            unit="1",
            default=1.0,
            low=1.0,
            high=64.0,
            sentence="Which of the machine's custom_laws, counted from 1.",
        ),
        Param(
            name="scale",
            unit="1",
            default=1.0,
            low=0.0,
            high=1e3,
            sentence="Factor on the law's force.",
        ),
    ),
    references=("the law is the user's own; language and limits are on the page",),
    severity="scale",
    wear=True,
    order=30,
    repeats="law",
    demo=Demo(leading=2, prepare=_demonstration, note="With a force of 50 cos(phi) + 20 cos(2 phi) N on bearing 1."),
    validation=(
        Validation(
            kind="closed form",
            source="period of Duffing's free motion by the complete elliptic integral, from its expression",
            deviation=1e-5,
            test="tests/sim/terms/test_custom_force.py::test_period_of_a_cubic_spring",
        ),
    ),
)
