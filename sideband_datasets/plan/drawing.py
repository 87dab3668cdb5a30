"""One recording of a plan, drawn: the machine with its fault at its operating point, its sensors, its seeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from pydantic import ValidationError

from sideband_datasets.plan.axes import Axis, drawn_only, recording_axes
from sideband_datasets.plan.check import sites_of
from sideband_datasets.plan.documents import holders, own_value
from sideband_datasets.plan.machines import Document, Machine, part, told_as, values_at, with_values
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.seeds import Stream, generator, whole_seed
from sideband_datasets.recipe.model import FaultClass
from sideband_datasets.recipe.values import Drawn
from signals.overrides import apply_overrides
from signals.sensors import SensorChain
from signals.shorthand import path_of
from signals.validation import problems_of
from sim.core.errors import Problem, SpecError
from sim.core.params import Param
from sim.core.spec import MachineSpec
from sim.core.terms import Term
from sim.terms import REGISTRY

NAMES = {"conditions.speed_hz": "speeds_hz", "conditions.torque_nm": "torques_nm"}
"""Problems of the operating point by the recipe's names."""


@dataclass(frozen=True, kw_only=True)
class Effect:
    """A term of the fault at its site; `severity` in `unit`, the value of its parameter `parameter`, if it has one."""

    term: str
    site: str
    parameter: str = ""
    severity: float | None = None
    unit: str = ""

    @property
    def label(self) -> str:
        """`outer_spall@bearing1`."""
        return f"{self.term}@{self.site}"


@dataclass(frozen=True, kw_only=True)
class Drawing:
    """Everything a recording is made from. `shift` is the place of its first window in the slack, 0 to 1.

    `seed` drives what is random in the machine (it belongs to the machine), `noise_seed` the measurement. `sound` is
    the machine without the fault at the same operating point.
    """

    number: int
    recording_id: str
    machine: Machine
    spec: MachineSpec
    sound: MachineSpec
    chain: SensorChain | None
    measurement: str
    fault_type: str
    effects: tuple[Effect, ...]
    split: str
    seed: int
    noise_seed: int
    shift: float


def drawing(plan: Plan, number: int) -> Drawing:
    """Recording `number`; a pure function of the recipe and the number. SpecError when it cannot be built."""
    recipe, kind = plan.recipe, int(plan.kind[number])
    fault = recipe.faults[kind - 1] if kind else None
    machine = plan.machines[int(plan.machine[number])]
    axes = recording_axes(recipe, fault, kind - 1)
    own = {axis.key: _own(axis, machine) for axis in drawn_only(axes) if axis.key.startswith(("condition", "chain"))}
    values = values_at(axes, plan.points(kind).at(int(plan.rank[number])), own)
    spec = sound = _at_point(machine.spec, values)
    effects: tuple[Effect, ...] = ()
    if fault is not None:
        spec, effects = _with_fault(spec, fault, values, f"faults.{kind - 1}.terms")
    # Siblings differ by the fault alone: what is random in their measurement has the seed of the first of them.
    first = number - number % len(recipe.classes) if recipe.siblings else number
    return Drawing(
        number=number,
        recording_id=f"{recipe.name}-{number:06d}",
        machine=machine,
        spec=spec,
        sound=sound,
        chain=_chain(machine, values),
        measurement="" if machine.measurement is None else recipe.measurement[machine.measurement].name,
        fault_type=recipe.classes[kind],
        effects=effects,
        split=plan.split(number),
        seed=machine.seed,
        noise_seed=whole_seed(recipe.seed, Stream.RECORDING, first),
        shift=float(generator(recipe.seed, Stream.SHIFT, first).uniform()),
    )


def _own(axis: Axis, machine: Machine) -> object:
    """What a machine and its chain have where something is drawn for every recording."""
    head, _, path = axis.key.partition(":")
    if head == "condition":
        return own_value(machine.spec, path_of(path))
    if machine.chain is None or head != f"chain.{machine.measurement}":
        return 1.0  # another chain's: drawn with the others, and not used
    found = list(holders(machine.chain, path, axis.field))
    return found[0][0].get(found[0][1])


def _at_point(spec: MachineSpec, values: Mapping[str, Drawn]) -> MachineSpec:
    changes: dict[str, object] = dict(part(values, "condition"))
    changes |= {key: values[key] for key in ("speed_hz", "torque_nm") if key in values}
    try:
        with told_as("conditions"):
            return apply_overrides(spec, changes)
    except SpecError as error:
        raise SpecError([replace(p, field=NAMES.get(p.field, p.field)) for p in error.problems]) from error


def _with_fault(
    spec: MachineSpec, fault: FaultClass, values: Mapping[str, Drawn], field: str
) -> tuple[MachineSpec, tuple[Effect, ...]]:
    changes: dict[str, object] = {}
    effects: list[Effect] = []
    for t, wanted in enumerate(fault.terms):
        term = REGISTRY.get(wanted.term)
        assert term is not None
        given = part(values, f"fault.{t}")
        share = given.pop("site")
        sites = _free(sites_of(spec, wanted, term, f"{field}.{t}.sites"), term.key, effects, f"{field}.{t}.sites")
        assert isinstance(share, float)
        site = sites[min(int(share * len(sites)), len(sites) - 1)]
        if not given:
            given = {p.name: p.default for p in term.params[:1]}
        changes |= {f"{term.key}@{site}.{name}": value for name, value in given.items()}
        effects.append(_effect(term, site, given))
    with told_as(field):
        return apply_overrides(spec, changes), tuple(effects)


def _free(sites: Sequence[str], term: str, effects: Sequence[Effect], field: str) -> list[str]:
    """Places where the same effect of this fault does not act already."""
    taken = {effect.site for effect in effects if effect.term == term}
    left = [site for site in sites if site not in taken]
    if not left:
        message = f"{term} acts at every one of these already, by another term of the fault"
        raise SpecError(Problem(field=field, message=message, given=", ".join(sites)))
    return left


def _effect(term: Term, site: str, given: Mapping[str, Drawn]) -> Effect:
    param: Param | None = next((p for p in term.params if p.name == term.severity), None)
    value = None if param is None else given.get(param.name)
    if param is None or isinstance(value, bool) or not isinstance(value, int | float):
        return Effect(term=term.key, site=site)
    return Effect(term=term.key, site=site, parameter=param.name, severity=float(value), unit=param.unit)


def _chain(machine: Machine, values: Mapping[str, Drawn]) -> SensorChain | None:
    if machine.measurement is None or machine.chain is None:
        return None
    field = f"measurement.{machine.measurement}"
    document: Document = with_values(machine.chain, part(values, f"chain.{machine.measurement}"), f"{field}.each")
    try:
        return SensorChain.model_validate(document)
    except ValidationError as error:
        raise SpecError(problems_of(error, prefix=f"{field}.chain", model=SensorChain)) from error
