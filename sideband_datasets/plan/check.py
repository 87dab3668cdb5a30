"""What of a recipe can be found wrong before any machine is drawn."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from sideband_datasets.plan.axes import Axis, drawn_only, recording_axes, term_parameters
from sideband_datasets.plan.machines import Family
from sideband_datasets.plan.most import counted_problems
from sideband_datasets.plan.quotas import IntArray
from sideband_datasets.plan.siblings import beside_problems
from sideband_datasets.recipe.model import FaultTerm, Recipe
from sideband_datasets.recipe.values import Choice, Factor, Range, Value, least, levels_of
from sim.assembly.assemble import assemble
from sim.assembly.laws import site_kinds
from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean
from sim.core.params import Param
from sim.core.spec import MachineSpec
from sim.core.terms import Term
from sim.solve.api import default_channels
from sim.terms import REGISTRY

OF_THE_MACHINE = ("path", "mounting")
"""Stages of a chain that belong to a machine: drawn anew for every recording they would be other machines' too."""


LEAST_SAMPLES = 16
"""Of a window."""


def check_recipe(recipe: Recipe) -> None:
    """SpecError lists what the registered effects and the recipe's own numbers forbid."""
    problems = [
        problem
        for c, fault in enumerate(recipe.faults)
        for t, wanted in enumerate(fault.terms)
        for problem in _term_problems(wanted, f"faults.{c}.terms.{t}")
    ]
    for k, choice in enumerate(recipe.measurement):
        for path in choice.each:
            if any(part in OF_THE_MACHINE for part in path.split(".")):
                message = "belongs to the machine: drawn for every recording, one path would stand in several splits"
                problems.append(Problem(field=f"measurement.{k}.each.{path}", message=message, allowed="`vary`"))
    problems += counted_problems(recipe)
    problems += _window_problems(recipe)
    problems += beside_problems(recipe)
    if problems:
        raise SpecError(problems)


def _term_problems(wanted: FaultTerm, field: str) -> Iterator[Problem]:
    term = REGISTRY.get(wanted.term)
    if term is None:
        hint = did_you_mean(wanted.term, REGISTRY.keys())
        allowed = "an effect of `sideband terms`"
        yield Problem(
            field=f"{field}.term", message=f"is no registered effect{hint}", given=wanted.term, allowed=allowed
        )
        return
    if not term.params:
        yield Problem(
            field=f"{field}.term", message="has no parameter, so no size: it cannot be a fault", given=term.key
        )
    known = {param.name: param for param in term.params}
    for name, value in term_parameters(wanted, term).items():
        at = f"{field}.parameters.{name}"
        if name not in known:
            message = f"is no parameter of {term.key}{did_you_mean(name, known)}"
            yield Problem(field=at, message=message, given=name, allowed=", ".join(known))
            continue
        yield from _value_problems(value, known[name], at)


def _value_problems(value: Value, param: Param, field: str) -> Iterator[Problem]:
    if isinstance(value, Factor):
        message = "has nothing to multiply: the effect is not in the machine yet"
        yield Problem(field=field, message=message, allowed="`low` and `high`")
        return
    if isinstance(value, Range):
        ends: dict[str, object] = {".low": value.low, ".high": value.high}
    elif isinstance(value, Choice):
        ends = {f".choices.{i}": item for i, item in enumerate(value.choices)}
    else:
        ends = {"": value}
    for end, number in ends.items():
        problem = param.problem(number, f"{field}{end}")
        if problem is not None:
            yield problem


def window_length_s(recipe: Recipe, speed_hz: float | None) -> float:
    """Length of a window at a speed of the driven shaft, s; the whole recording where nothing is said."""
    windows = recipe.windows
    if windows.length_s is not None:
        return windows.length_s
    if windows.length_revolutions is None:
        return recipe.duration_s / windows.span(1.0)
    if not speed_hz:
        message = "counts revolutions, but nothing turns in this machine"
        raise SpecError(Problem(field="windows.length_revolutions", message=message, allowed="`length_s`"))
    return windows.length_revolutions / speed_hz


def _window_problems(recipe: Recipe) -> Iterator[Problem]:
    windows = recipe.windows
    slowest = least(recipe.speeds_hz) if recipe.speeds_hz is not None else None
    if slowest is not None and slowest <= 0:
        yield Problem(field="speeds_hz", message="must be above zero", given=slowest, unit="Hz")
        return
    if windows.length_revolutions is not None and slowest is None:
        return  # the machine's own speed decides: told when its recording is cut
    if windows.length_s is not None and windows.length_s * recipe.sampling_rate_hz < LEAST_SAMPLES:
        message, allowed = "is too short", f">= {LEAST_SAMPLES / recipe.sampling_rate_hz:g}"
        yield Problem(field="windows.length_s", message=message, given=windows.length_s, allowed=allowed, unit="s")
    span = windows.span(window_length_s(recipe, slowest))
    if span > recipe.duration_s * (1 + 1e-9):
        at = f" at {slowest:g} Hz" if windows.length_revolutions is not None else ""
        message = f"{windows.per_recording} windows need {span:.4g} s{at}; the recording is shorter"
        allowed = f">= {span:.6g}"
        yield Problem(field="duration_s", message=message, given=recipe.duration_s, allowed=allowed, unit="s")


def sites_of(machine: MachineSpec, wanted: FaultTerm, term: Term, field: str) -> list[str]:
    """Parts of a machine where an effect of a fault may act, in a fixed order; SpecError when there is none."""
    kinds = site_kinds(machine)
    able = [site for site, kind in kinds.items() if kind in term.sites]
    found = [site for site in wanted.sites if site in able] if wanted.sites else able
    if not found:
        hint = did_you_mean(wanted.sites[0], able) if wanted.sites else ""
        message = f"{machine.name} has none of these parts where {term.key} may act{hint}"
        raise SpecError(Problem(field=field, message=message, given=wanted.sites, allowed=", ".join(able) or "none"))
    return found


def channels_of(recipe: Recipe, families: Sequence[Family]) -> int:
    """Channels of a recording: the same number in all, so that a row has one number."""
    if recipe.measurement:
        counts = {m.name: _listed(m.chain.get("channels")) for m in recipe.measurement}
        field = "measurement"
    else:
        field = "machines"
        firsts = [family.built(0) for family in families]
        counts = {first.family: len(default_channels(assemble(first.spec))) for first in firsts}
    if len(set(counts.values())) > 1:
        told = ", ".join(f"{name}: {count}" for name, count in counts.items())
        raise SpecError(Problem(field=field, message="must all give the same number of channels", given=told))
    return next(iter(counts.values()))


def _listed(value: object) -> int:
    return len(value) if isinstance(value, list) else 0


def split_warnings(
    recipe: Recipe, family_of: IntArray, split_of: IntArray, kind: IntArray, machine: IntArray
) -> Iterator[str]:
    """Sentences on classes and families that are missing in a split, and on paths that all machines share."""
    names = list(recipe.splits)
    split = split_of[machine]
    for number, name in enumerate(recipe.classes):
        present = np.unique(split[kind == number])
        missing = [names[s] for s in range(len(names)) if s not in present]
        if len(missing) == len(names) and (number or recipe.healthy_share != 0.0):
            yield f"class {name} has no recording: too small a share of {recipe.count}"
        elif 0 < len(missing) < len(names):
            yield f"class {name} does not occur in {', '.join(missing)}: too few recordings for every split"
    for number, family in enumerate(recipe.machines):
        own = set(split_of[family_of == number].tolist())
        if len(own) < len(names):
            missing = [names[s] for s in range(len(names)) if s not in own]
            yield f"machines {family.name} do not occur in {', '.join(missing)}: too few `instances`"


def confounded_warnings(recipe: Recipe, kind: IntArray) -> Iterator[str]:
    """Sentences on factors of a factorial plan that have more pairs of levels than a class has recordings."""
    if recipe.plan != "factorial":
        return
    for number, name in enumerate(recipe.classes):
        count = int(np.count_nonzero(kind == number))
        fault = recipe.faults[number - 1] if number else None
        axes = [axis for axis in drawn_only(recording_axes(recipe, fault, number - 1)) if _steers(recipe, axis)]
        told = [
            f"{a.field} with {b.field} ({levels_of(a.value) * levels_of(b.value)} pairs)"
            for a, b in combinations(axes, 2)
            if levels_of(a.value) * levels_of(b.value) > count
        ]
        if count and told:
            yield (
                f"class {name} has {count} recordings, fewer than pairs of levels of two factors, "
                f"so one tells of the other: {'; '.join(told)}"
            )


def _steers(recipe: Recipe, axis: Axis) -> bool:
    """Whether the levels of an axis differ: not where a fault has a single place."""
    if levels_of(axis.value) == 1:
        return False
    parts = axis.field.split(".")
    return parts[-1] != "sites" or len(recipe.faults[int(parts[1])].terms[int(parts[3])].sites) != 1
