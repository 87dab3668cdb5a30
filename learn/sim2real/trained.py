"""A model from simulations, and those of smaller data sets beside it, by a pool in which no process waits for another.

Gear pairs are simulated where a process has no dataset left to make, and smaller datasets are made while the main
process trains; what comes out is the same as one after the other.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

from learn.dataset import machines_of
from learn.model import Model, save
from learn.real.load import available
from learn.sim2real import gear_table, table, training_data
from learn.sim2real.ablations import INGREDIENTS, USUAL
from learn.sim2real.gear_table import GearExample, gear_heads
from learn.sim2real.table import Table, some, train
from learn.sim2real.training_data import recipes
from sideband_datasets.recipe.bearings import UNUSUAL_NAME
from sideband_datasets.recipe.read import identity
from sim.version import PHYSICS_VERSION

Tell = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Trained:
    """`ablated`: models of smaller data sets by their names; `held`: what the training sets held, in words."""

    model: Model
    ablated: Mapping[str, Model] = field(default_factory=dict)
    held: str = ""


@dataclass(frozen=True, kw_only=True)
class _Simulated:
    """Features of bearings and of gear pairs; `usual`: machines with bearings of the catalogue."""

    found: Table
    usual: Sequence[int]
    pairs: Sequence[GearExample]

    @property
    def held(self) -> str:
        """In words."""
        machines, pairs = len(set(self.found.machines)), len({p.machine for p in self.pairs})
        of_bearings = f"{machines} machines, {len(self.found.labels)} pieces"
        return f"{of_bearings}; {pairs} gear pairs, {len(self.pairs)} recordings"


def trained(given: argparse.Namespace, pool: Executor, tell: Tell) -> Trained:
    """Everything that `given` asks for; the model is written as soon as it is there."""
    data = _simulated(given, pool, tell)
    tell(f"simulated: {data.held}")
    others = USUAL[1:] if given.ablated and available() else ()
    with ExitStack() as stack:
        waiting = {
            name: stack.enter_context(
                training_data.begun(
                    recipes(given.ablated, given.seed + 1, INGREDIENTS[name]), None, given.processes, pool
                )
            )
            for name in others
        }
        model = _model(given, data)
        if given.model is not None:
            save(model, given.model)
        tell("trained")
        ablated = _ablated(given, data, waiting, pool, tell) if others else {}
    return Trained(model=model, ablated=ablated, held=data.held)


def _simulated(given: argparse.Namespace, pool: Executor, tell: Tell) -> _Simulated:
    """Features of the datasets that are given, or of those that are made, and of gear pairs."""
    with ExitStack() as stack:
        if given.dataset:
            folders: Sequence[Path] = given.dataset
            gears = gear_table.begun(given.pairs, given.seed, pool)
        else:
            wanted = recipes(given.machines, given.seed)
            made = stack.enter_context(training_data.begun(wanted, given.keep, given.processes, pool))
            gears = gear_table.begun(given.pairs, given.seed, pool)
            folders = made()
            tell(f"datasets made: {', '.join(folder.name for folder in folders)}")
        shares = table.begun(folders, pool)
        pairs = gear_table.gears_of(gears)
        tell(f"{len({p.machine for p in pairs})} gear pairs simulated, {len(pairs)} recordings")
        return _Simulated(found=table.tabled(shares), usual=_usual(folders), pairs=pairs)


def _usual(folders: Sequence[Path]) -> list[int]:
    return [k for k, name in enumerate(machines_of(folders)) if not name.startswith(UNUSUAL_NAME)]


def _model(given: argparse.Namespace, data: _Simulated) -> Model:
    heads = {**train(data.found, seed=given.seed, made_by={}).heads, **gear_heads(list(data.pairs), given.seed)}
    return Model(heads=heads, made_by=_made_by(given, data.found, data.pairs))


def _made_by(given: argparse.Namespace, found: Table, pairs: Sequence[GearExample]) -> dict[str, object]:
    return {
        "command": f"python -m learn.sim2real --machines {given.machines} --pairs {given.pairs} --seed {given.seed}",
        "recipes": {} if given.dataset else {r.name: identity(r) for r in recipes(given.machines, given.seed)},
        "physics_version": PHYSICS_VERSION,
        "machines": len(set(found.machines)),
        "rows": len(found.labels),
        "gear_pairs": len({p.machine for p in pairs}),
        "gear_rows": len(pairs),
        "real_samples": 0,
    }


def _ablated(
    given: argparse.Namespace,
    data: _Simulated,
    waiting: Mapping[str, Callable[[], list[Path]]],
    pool: Executor,
    tell: Tell,
) -> dict[str, Model]:
    """Models of smaller data sets of the catalogue's bearings, the first a part of the large one;
    `learn.sim2real.ablations` has more of them."""
    tables = {name: table.begun(folders(), pool) for name, folders in waiting.items()}
    part = some(data.found, given.ablated, data.usual)
    parts = {USUAL[0]: part, **{name: table.tabled(shares) for name, shares in tables.items()}}
    for name, one in parts.items():
        tell(f"{name}: {len(one.labels)} pieces of {len(set(one.machines))} machines")
    return {name: train(one, seed=given.seed, made_by={}) for name, one in parts.items()}
