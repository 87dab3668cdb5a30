"""Made machines that may rub at two gears, as the simulator would show them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.calibrate.uncertain import Offsets
from reconcile.judge.screen import judge
from reconcile.judge.space import Library, fit_space
from reconcile.machine import left_pairs, left_start
from reconcile.machine.library import Catalogued, joined
from reconcile.machine.setting import Found
from sim.core.spec import TermSpec
from tests.reconcile.judge.made import FEATURES, changes, world

RIGHT, WRONG = "rub@gear", "rub@pinion"
NUMBERS, MEMBERS = 3, 16
SIZES = (1e6, 1e8)
Asked = list[tuple[str, list[np.ndarray], list[TermSpec]]]


class Made:
    """Machines of three numbers: an effect's change grows with its size along one pattern, and the numbers turn it."""

    def __init__(self) -> None:
        rng = np.random.default_rng(2)
        self.patterns = {RIGHT: np.zeros(FEATURES), WRONG: np.zeros(FEATURES)}
        self.patterns[RIGHT][:30], self.patterns[WRONG][30:] = 8.0, 8.0
        self.turns = {name: rng.normal(0.0, 60.0, (NUMBERS, FEATURES)) * (p != 0) for name, p in self.patterns.items()}

    def change(self, name: str, numbers: np.ndarray, stiffness: float) -> np.ndarray:
        """(F,) dB."""
        share = np.log(stiffness / SIZES[0]) / np.log(SIZES[1] / SIZES[0])
        return np.asarray(self.patterns[name] * (0.5 + share) + numbers @ self.turns[name])

    def catalogue(
        self, name: str, offsets: list[np.ndarray], terms: list[TermSpec], also: Sequence[TermSpec] = ()
    ) -> Catalogued:
        """As the simulator would make it; decibels of two effects add, as neither moves what the other does."""
        rows = [self.change(name, o, t.parameters["stiffness"]) for o, t in zip(offsets, terms, strict=True)]
        for k, second in enumerate(also):
            rows[k] = rows[k] + self.change(f"rub@{second.site}", offsets[k], second.parameters["stiffness"])
        shares = np.array([np.log(t.parameters["stiffness"] / SIZES[0]) / np.log(100.0) for t in terms])
        count = tuple(range(len(rows)))
        library = Library(changes=np.array(rows), groups={name: count}, shares=shares)
        moved = tuple(Offsets(values=np.asarray(o)) for o in offsets)
        return Catalogued(library=library, terms=tuple(terms), pairs=count, offsets=moved)


MADE = Made()


def term(name: str, stiffness: float) -> TermSpec:
    return TermSpec(term="rub", site=name.split("@")[1], parameters={"stiffness": stiffness})


def found_in(observed: np.ndarray) -> tuple[SimpleNamespace, Found]:
    """Sixteen draws of either effect on as many machines."""
    rng = np.random.default_rng(4)
    machines = rng.uniform(-0.1, 0.1, (MEMBERS, NUMBERS))
    sizes = np.exp(rng.uniform(*np.log(SIZES), MEMBERS))
    parts = [MADE.catalogue(n, list(machines), [term(n, s) for s in sizes]) for n in (RIGHT, WRONG)]
    both = Library(
        changes=np.concatenate([p.library.changes for p in parts]),
        groups={RIGHT: tuple(range(MEMBERS)), WRONG: tuple(range(MEMBERS, 2 * MEMBERS))},
        shares=np.concatenate([p.library.shares for p in parts]),
    )
    known = joined(parts[0], parts[1])
    known = replace(known, library=both, pairs=tuple(range(MEMBERS)) * 2)
    seen = changes(world(), observed)
    views = fit_space(seen, both, seed=1), fit_space(seen, both, seed=1, view=seen.single)
    screen = judge(views, observed, {}, 1.0)
    setting = SimpleNamespace(
        changes=seen,
        seed=0,
        machine=SimpleNamespace(gears=("gear", "pinion")),
        direct=SimpleNamespace(evidence={}, p=1.0),
        data=(None,),
        plan=SimpleNamespace(offsets=tuple(Offsets(values=m) for m in machines)),
    )
    return setting, Found(known=known, fitted=views[0], fine=views[1], screen=screen)


def asked_of_the_made(monkeypatch: pytest.MonkeyPatch, third: str) -> Asked:
    """Pairs are simulated by asking the made machines; what was asked for. The effect `third` shows nothing."""
    asked: Asked = []
    for made in (MADE.patterns, MADE.turns):
        monkeypatch.setitem(made, third, 0.0 * made[RIGHT])

    def again(_setting, candidate, offsets, terms, _mapper, also=()):  # type: ignore[no-untyped-def]
        second = also[0].site if also else "nothing"
        asked.append((f"{candidate.label}+{second}", [o.values for o in offsets], list(also)))
        return MADE.catalogue(candidate.label, [o.values for o in offsets], list(terms), also)

    for module in (left_pairs, left_start):
        monkeypatch.setattr(module, "simulated_again", again, raising=False)
    return asked
