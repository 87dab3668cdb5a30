"""The plan of a recipe, with one recording of every class and family put together before hours are spent on it."""

from __future__ import annotations

import json
from collections.abc import Hashable
from dataclasses import replace
from functools import lru_cache

import numpy as np

from sideband_datasets.plan.carried import told_of_rates
from sideband_datasets.plan.drawing import Drawing, drawing
from sideband_datasets.plan.plan import Plan, inspected, laid_out
from sideband_datasets.plan.quotas import IntArray
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.read import canonical
from signals.sensors import SensorChain, outputs_needed, pickups, quantities_of
from signals.sensors.clock import nominal_rate_hz
from signals.validation import Findings
from sim.assembly.assemble import assemble
from sim.core.system import System
from sim.solve.ensemble import structure
from sim.solve.step_choice import steps_per_output


def outputs_of(plan: Plan, drawn: Drawing, system: System) -> tuple[str, ...] | None:
    """Outputs to simulate: those of every chain of the recipe, so that machines with different ones can run side by
    side; None for the standard ones. SpecError when the recording's own chain cannot be served.
    """
    if drawn.chain is None:
        return None
    known = quantities_of(channel.name for channel in system.channels)
    needed = outputs_needed(pickups(drawn.chain, drawn.spec, known, "measurement.chain"))
    families = [machines.name for machines in plan.recipe.machines]
    for k in plan.recipe.chains_of(families.index(drawn.machine.family)):
        chain = _chain(_text(plan.recipe.measurement[k].chain))
        needed += outputs_needed(pickups(chain, drawn.spec, known, f"measurement.{k}.chain"))
    return tuple(sorted(set(needed))) or tuple(known)[:1]


def alike(plan: Plan, system: System, outputs: tuple[str, ...] | None) -> Hashable:
    """What machines must share to be simulated side by side."""
    return structure(system), steps_per_output(system, plan.recipe.sampling_rate_hz), outputs


@lru_cache(maxsize=64)
def _chain(text: str) -> SensorChain:
    return SensorChain.model_validate_json(text)


def _text(chain: object) -> str:
    """A chain as one text."""
    return json.dumps(chain, sort_keys=True)


def cells_of(plan: Plan) -> IntArray:
    """Number of the class on the family that each recording is, shape (recordings,)."""
    _, first, family = np.unique(plan.family, return_index=True, return_inverse=True)
    number = first[family.reshape(-1)][plan.machine]
    _, cells = np.unique(np.stack([plan.kind, number]), axis=1, return_inverse=True)
    return np.asarray(cells, dtype=np.int64).reshape(-1)


def samples_of(plan: Plan) -> list[Drawing]:
    """The first recording of every class on every family."""
    _, first = np.unique(cells_of(plan), return_index=True)
    return [drawing(plan, int(i)) for i in sorted(first)]


@lru_cache(maxsize=4)
def _tried(text: str) -> Plan:
    recipe = Recipe.model_validate_json(text)
    plan = laid_out(recipe)
    inspected(plan)
    findings = Findings()
    tried: list[tuple[Drawing, System]] = []
    for drawn in samples_of(plan):
        with findings.step():
            system = assemble(drawn.spec, seed=drawn.seed)
            tried.append((drawn, system))
            outputs_of(plan, drawn, system)
            if drawn.chain is not None:
                nominal_rate_hz(drawn.chain.clock, recipe.sampling_rate_hz, "measurement.chain.clock")
    findings.settle()
    return replace(plan, warnings=(*plan.warnings, *told_of_rates(recipe, tried)))


def make_plan(recipe: Recipe) -> Plan:
    """The plan of a recipe; SpecError lists what of it cannot be made."""
    return _tried(canonical(recipe))


@lru_cache(maxsize=4)
def _again(text: str) -> Plan:
    return laid_out(Recipe.model_validate_json(text))


def plan_again(recipe: Recipe) -> Plan:
    """The plan of a recipe that `make_plan` took before: the same recordings, in a time that does not grow with the
    number of machines. None is built yet, nothing is checked again, and warnings of sampling rates are left out.
    """
    return _again(canonical(recipe))
