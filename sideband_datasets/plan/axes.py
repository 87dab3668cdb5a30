"""The quantities that are drawn: one axis of a plan for each, in a fixed order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from sideband_datasets.recipe.model import FaultClass, FaultTerm, Machines, Recipe
from sideband_datasets.recipe.values import Choice, Factor, Range, Value, levels_of
from sim.core.params import Param
from sim.core.terms import Term
from sim.terms import REGISTRY

SMALLEST_OF_RANGE = 0.05
SMALLEST_OF_LOG_RANGE = 1e-3
"""Of the largest value a parameter may have: where a severity range begins that includes zero, which is no fault."""


@dataclass(frozen=True, kw_only=True)
class Axis:
    """`key` is unique in its plan; `field` is where the recipe says it."""

    key: str
    field: str
    value: Value


def drawn_only(axes: Sequence[Axis]) -> tuple[Axis, ...]:
    """Those with anything to draw: fixed values take no dimension."""
    return tuple(axis for axis in axes if isinstance(axis.value, Range | Factor | Choice))


def levels(axes: Sequence[Axis]) -> tuple[int, ...]:
    """Levels of each axis in a factorial plan."""
    return tuple(levels_of(axis.value) for axis in axes)


def _each(prefix: str, field: str, values: Mapping[str, Value]) -> list[Axis]:
    return [Axis(key=f"{prefix}{key}", field=f"{field}.{key}", value=value) for key, value in values.items()]


def machine_axes(recipe: Recipe, number: int) -> tuple[Axis, ...]:
    """What is drawn once a machine of family `number`: its parameters, its chain, what of each chain is its own."""
    family: Machines = recipe.machines[number]
    axes = _each("machine:", f"machines.{number}.vary", family.vary)
    chains = recipe.chains_of(number)
    if chains:
        names = Choice(choices=tuple(recipe.measurement[k].name for k in chains))
        axes.append(Axis(key="chain", field="measurement", value=names if len(chains) > 1 else names.choices[0]))
    for k in chains:
        axes += _each(f"chain.{k}:", f"measurement.{k}.vary", recipe.measurement[k].vary)
    return tuple(axes)


def severity_range(param: Param) -> Range:
    """The range a severity declares, without the zero that is no fault."""
    share = SMALLEST_OF_LOG_RANGE if param.scale == "log" else SMALLEST_OF_RANGE
    return Range(low=max(param.low, share * param.high), high=param.high, scale=param.scale)


def term_parameters(wanted: FaultTerm, term: Term) -> dict[str, Value]:
    """Ranges of a fault's parameters, with that of the severity when it is not given."""
    given: dict[str, Value] = {}
    for param in term.params:
        if param.name == term.severity and param.name not in wanted.parameters:
            given[param.name] = severity_range(param)
    return {**given, **wanted.parameters}


def recording_axes(recipe: Recipe, fault: FaultClass | None, number: int) -> tuple[Axis, ...]:
    """What is drawn for every recording of a class (number `number` of `faults`; None: healthy)."""
    axes: list[Axis] = []
    if recipe.speeds_hz is not None:
        axes.append(Axis(key="speed_hz", field="speeds_hz", value=recipe.speeds_hz))
    if recipe.torques_nm is not None:
        axes.append(Axis(key="torque_nm", field="torques_nm", value=recipe.torques_nm))
    axes += _each("condition:", "conditions", recipe.conditions)
    for k, choice in enumerate(recipe.measurement):
        axes += _each(f"chain.{k}:", f"measurement.{k}.each", choice.each)
    for t, wanted in enumerate(fault.terms if fault else ()):
        term = REGISTRY.get(wanted.term)
        assert term is not None
        field = f"faults.{number}.terms.{t}"
        # The parts that can be drawn depend on the machine: a place among them is drawn, not a name.
        axes.append(Axis(key=f"fault.{t}:site", field=f"{field}.sites", value=Range(low=0.0, high=1.0, levels=2)))
        axes += _each(f"fault.{t}:", f"{field}.parameters", term_parameters(wanted, term))
    return tuple(axes)
