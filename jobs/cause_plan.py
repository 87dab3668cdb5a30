"""Which runs the causes of a machine's lines take: coalitions of its terms, then its own excitations taken away."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

from jobs.counterfactuals import Effect, active_terms, base_excitations, idle_terms
from jobs.request import SimulationRequest
from signals.labels.cause import Coalition, Rule, coalitions
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec

MAX_RUNS = 32


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What has to be run. `removals`: excitations of the base machine taken away together, by index, single ones first.

    `left_out`: excitations of the base machine there is no room for.
    """

    effects: tuple[Effect, ...]
    idle: tuple[Effect, ...]
    rule: Rule
    coalitions: tuple[Coalition, ...]
    excitations: tuple[Effect, ...]
    removals: tuple[Coalition, ...]
    left_out: tuple[Effect, ...]

    @property
    def runs(self) -> int:
        """Counterfactual runs, beside the run itself."""
        return len(self.coalitions) + len(self.removals)


def plan_causes(machine: MachineSpec) -> Plan:
    """Runs that a machine's causes take; SpecError when its terms need more than `MAX_RUNS`."""
    effects = active_terms(machine)
    rule, groups = coalitions(len(effects))
    if len(groups) > MAX_RUNS:
        message = f"needs {len(groups)} further runs, one for each effect of the machine and one without any"
        raise SpecError(Problem(field="causes", message=message, given=True, allowed=f"<= {MAX_RUNS} runs"))
    own = base_excitations(machine)
    room = MAX_RUNS - len(groups)
    kept = own[:room]
    removals = [frozenset({i}) for i in range(len(kept))] + _alike(kept, machine)
    return Plan(
        effects=effects,
        idle=idle_terms(machine),
        rule=rule,
        coalitions=groups,
        excitations=kept,
        removals=tuple(removals[:room]),
        left_out=own[room:],
    )


def further_runs(machine: MachineSpec, request: SimulationRequest) -> int:
    """Runs a request takes beside the one it asks for; SpecError when they are too many."""
    return plan_causes(machine).runs if request.causes else 0


def _alike(excitations: Sequence[Effect], machine: MachineSpec) -> list[Coalition]:
    """Pairs that make the same lines, so that neither takes them away alone: both excitations of a mesh, the balls of
    equal bearings on one shaft.
    """
    shafts: dict[str, str | None] = {gear.name: gear.shaft for gear in machine.gears}
    shafts |= {body.name: body.shaft for body in machine.bodies}
    lines: dict[str, object] = {mesh.name: mesh.name for mesh in machine.meshes}
    lines |= {b.name: (shafts.get(b.body), b.catalogue, b.geometry) for b in machine.bearings}
    pairs = combinations(enumerate(excitations), 2)
    return [frozenset({i, j}) for (i, a), (j, b) in pairs if lines[a.site] == lines[b.site]]
