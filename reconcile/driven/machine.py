"""From the fitted model back to a specification that the simulator runs, with the input of the stretch shown."""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import ValidationError

from reconcile.driven.channels import Driven, FloatArray
from reconcile.driven.model import Model
from reconcile.force_law.library import Law
from signals.validation import problem_of
from sim.core.errors import Problem, SpecError
from sim.core.spec import BodySpec, CustomLaw, ForceLoad, MachineSpec, MeasuredLoad, TermSpec
from sim.terms import REGISTRY

REGISTERED = {"cubic": ("cubic_support", "cubic"), "dry_friction": ("coulomb_friction", "force")}
"""Laws that have an effect of their own, with the parameter that carries the coefficient."""
OWN_LAW = "custom_force"
AXIS_SPRING = {"x": 0.0, "y": 1.0}
"""What effects at a body's support call its axes."""
AXIS_PARAMETERS = ("spring", "joint")


@dataclass(frozen=True, kw_only=True)
class Site:
    """The body that is driven, and the axis on which it moves."""

    body: BodySpec
    axis: str

    @property
    def dof(self) -> str:
        """Its degree of freedom."""
        return f"{self.body.name}.{self.axis}"


def driven_site(spec: MachineSpec) -> Site:
    """The one body of an oscillator; SpecError when the machine is more than that."""
    others = len(spec.shafts) + len(spec.gears) + len(spec.bearings) + len(spec.meshes)
    if len(spec.bodies) != 1 or others:
        given = f"{len(spec.bodies)} bodies, {others} shafts, gears, bearings and meshes"
        message = "a measured input can be reconciled with one mass on a spring (the preset `oscillator`)"
        raise SpecError(Problem(field="bodies", message=message, given=given, allowed="one body, nothing else"))
    body = spec.bodies[0]
    axis = next((x.axis for x in spec.loads if isinstance(x, MeasuredLoad)), "y" if "y" in body.axes else "x")
    return Site(body=body, axis=axis)


def check_linear(spec: MachineSpec) -> None:
    """SpecError for a file that has laws of its own: what is missing is looked for beside a linear spring, and a law
    that the file has already would be found, and added, once more."""
    message = "a measured input is held against the mass on its linear spring alone, to find all that acts beside it"
    for field, several in (
        ("terms", [t.term for t in spec.terms]),
        ("custom_laws", [x.name for x in spec.custom_laws]),
    ):
        if several:
            raise SpecError(
                Problem(
                    field=f"machine.{field}", message=message, given=", ".join(several), allowed="none: leave them out"
                )
            )


def mass_kg(model: Model, data: Driven, site: Site) -> float:
    """Mass: from the gain where force and motion are calibrated, else the specification's (it sets the scale)."""
    return 1.0 / model.gain if weighed(model, data) else site.body.mass_kg


def weighed(model: Model, data: Driven) -> bool:
    """Whether the recording tells the mass."""
    return data.calibrated and data.drive_channel.unit == "N" and model.gain > 0


def term_key(law: Law) -> str:
    """Registered effect that carries a law, or `custom_force`."""
    key = REGISTERED.get(law.key, (OWN_LAW, ""))[0]
    return key if REGISTRY.get(key) is not None else OWN_LAW


def registered(law: Law, coefficient: float, site: Site) -> TermSpec | None:
    """The registered effect with this coefficient; None where there is none or its bounds forbid it."""
    key = term_key(law)
    term = REGISTRY.get(key)
    if key == OWN_LAW or term is None:
        return None
    values = {REGISTERED[law.key][1]: coefficient}
    values |= {p.name: AXIS_SPRING[site.axis] for p in term.params if p.name in AXIS_PARAMETERS}
    if any(p.name == "friction_speed" for p in term.params):
        values["friction_speed"] = law.shape
    try:
        term.values(values, "terms")
    except SpecError:
        return None
    return TermSpec(term=key, site=site.body.name, parameters=values)


def revised(spec: MachineSpec, model: Model, data: Driven, drive: FloatArray) -> MachineSpec:
    """The oscillator with the fitted numbers and laws, driven by `drive` (n,) in the channel's own unit."""
    site = driven_site(spec)
    mass = mass_kg(model, data, site)
    stiffness, damping = mass * model.stiffness, mass * model.damping
    spring = {"stiffness_y_n_per_m": stiffness, "damping_y_ns_per_m": damping}
    if site.axis == "x":
        spring = {"stiffness_x_n_per_m": stiffness, "damping_x_ns_per_m": damping}
    body = site.body.model_copy(update={"mass_kg": mass, "axes": site.axis, **spring})
    loads = [
        MeasuredLoad.model_validate(
            {
                "body": body.name,
                "axis": site.axis,
                "step_s": data.step_s,
                "values": tuple(float(v) for v in drive),
                "factor": mass * model.gain,
            }
        ),
        ForceLoad.model_validate({"body": body.name, "axis": site.axis, "constant_n": mass * model.offset}),
    ]
    terms: list[TermSpec] = list(spec.terms)
    laws: list[CustomLaw] = list(spec.custom_laws)
    for law, coefficient in zip(model.laws, model.coefficients, strict=True):
        found = registered(law, mass * coefficient, site)
        if found is None:
            laws.append(CustomLaw(name=law.key, dof=site.dof, expression=law.expression(mass * coefficient)))
            found = TermSpec(term=OWN_LAW, site=body.name, parameters={"law": float(len(laws))})
        terms.append(found)
    update = {"bodies": [body], "loads": loads, "terms": terms, "custom_laws": laws}
    try:
        return MachineSpec.model_validate(spec.model_copy(update=update).model_dump(mode="json"))
    except ValidationError as error:
        raise SpecError([problem_of(e, "machine", MachineSpec) for e in error.errors()]) from None
