"""Whether a machine takes what a recipe draws for it: both ends of every range and every choice, by the recipe's names.

What is drawn in between is then within the bounds too, so a wrong end is found whatever is drawn, and told as written.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import islice

from sideband_datasets.plan.documents import own_value
from sideband_datasets.plan.machines import base_machine
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.values import Choice, Drawn, Factor, Range, Value
from signals.overrides import apply_overrides
from signals.shorthand import path_of
from sim.assembly.assemble import assemble
from sim.assembly.laws import site_kinds
from sim.core.errors import Problem, SpecError, UnknownName
from sim.core.near import did_you_mean
from sim.core.spec import MachineSpec
from sim.terms import REGISTRY

MOST = 4000
"""Ends that are tried, a quarter of a millisecond each; beyond them what is drawn tells."""


def check_ends(recipe: Recipe) -> None:
    """SpecError lists the ends and choices that no machine of a family can have; each is tried alone."""
    problems = list(islice(_problems(recipe), 32))
    if problems:
        raise SpecError(problems)


def _problems(recipe: Recipe) -> Iterator[Problem]:
    everywhere: dict[str, tuple[str, Value]] = {k: (f"conditions.{k}", v) for k, v in recipe.conditions.items()}
    for key, field in (("speed_hz", "speeds_hz"), ("torque_nm", "torques_nm")):
        value = getattr(recipe, field)
        if value is not None:
            everywhere[key] = field, value
    told: set[str] = set()
    left = MOST
    for number, family in enumerate(recipe.machines):
        base = base_machine(family, number)
        own = {key: (f"machines.{number}.vary.{key}", value) for key, value in family.vary.items()}
        for key, (field, value) in (own | everywhere).items():
            for end, given in _ends(value, base, key, field):
                left -= 1
                problem = _problem(base, key, given, end) if left >= 0 and end not in told else None
                if problem is not None:
                    told.add(end)
                    yield problem


def _ends(value: Value, base: MachineSpec, key: str, field: str) -> Iterator[tuple[str, Drawn]]:
    if isinstance(value, Range):
        yield from ((f"{field}.low", value.low), (f"{field}.high", value.high))
    elif isinstance(value, Choice):
        yield from ((f"{field}.choices.{k}", item) for k, item in enumerate(value.choices))
    elif isinstance(value, Factor):
        own = own_value(base, path_of(key))
        if isinstance(own, int | float) and not isinstance(own, bool):
            yield from ((f"{field}.factor.{k}", own * end) for k, end in enumerate(value.factor))
    else:
        yield field, value


def _problem(base: MachineSpec, key: str, given: Drawn, field: str) -> Problem | None:
    """What is wrong with a value of its own; not what only others beside it make wrong."""
    if "@" in key:
        return _of_term(base, key, given, field)
    try:
        changed = apply_overrides(base, {key: given})
    except SpecError as error:
        return next((replace(p, field=field) for p in error.problems if p.field == f"set.{key}"), None)
    if not isinstance(given, str):
        return None
    try:
        assemble(changed)
    except UnknownName as error:
        message = f"is an unknown {error.kind}{did_you_mean(given, error.known)}"
        return Problem(field=field, message=message, given=given, allowed=", ".join(error.known))
    except SpecError as error:
        first = error.problems[0]
        return replace(first, field=field, message=f"{first.field}: {first.message}", given=given)
    return None


def _of_term(base: MachineSpec, key: str, given: Drawn, field: str) -> Problem | None:
    name, _, place = key.partition("@")
    site, _, parameter = place.partition(".")
    term = REGISTRY.get(name)
    if term is None:
        hint = did_you_mean(name, REGISTRY.keys())
        return Problem(
            field=field, message=f"is no registered effect{hint}", given=name, allowed="see `sideband terms`"
        )
    kinds = site_kinds(base)
    able = [s for s, kind in kinds.items() if kind in term.sites]
    if site not in able:
        message = f"{base.name} has no such part where {name} may act{did_you_mean(site, able)}"
        return Problem(field=field, message=message, given=site, allowed=", ".join(able) or "none")
    known: Mapping[str, object] = {p.name: p for p in term.params}
    found = next((p for p in term.params if p.name == parameter), None)
    if found is None:
        message = f"is no parameter of {name}{did_you_mean(parameter, known)}"
        return Problem(field=field, message=message, given=parameter, allowed=", ".join(known))
    return found.problem(given, field)
