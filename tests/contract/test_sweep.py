"""Every effect at every legal site, and at the corners of its parameters: finite signals or a refusal that says why."""

from __future__ import annotations

import numpy as np
import pytest

from sim.core.errors import Diverged, Meaningless, SpecError
from sim.core.response import Response
from sim.core.spec import MachineSpec, TermSpec
from sim.core.terms import SiteKind, Term
from sim.presets import preset
from sim.solve.ensemble import Member, simulate_many
from sim.solve.settings import Settings
from sim.terms import REGISTRY

MACHINES = ("paper-lightly-damped", "rotor", "gear-pair")
"""A gearbox, a rotor in two bearings, gears without bearings: every site of theirs."""
FLEXIBLE = {
    "two-stage": {"gear1", "bearing4", "mesh2", "idler"},
    "bearing-rig": {"rotor", "disc", "drive_end", "motor"},
    "overhung": {"pinion", "bearing2", "mesh1", "input"},
}
"""Machines on flexible shafts, and the sites that are tried in them: one of a kind, or two; among them the gear of the
middle shaft and the pinion beyond its bearings."""
QUICK = Settings(estimate_error=False)
SPAN = {"duration_s": 0.01, "output_rate_hz": 20_000.0}
DIVERGENT_SHARE = 0.05
"""Share of all corner cases that may end in a reported divergence, or in numbers that are refused."""


def sites(machine: MachineSpec) -> dict[SiteKind, tuple[str, ...]]:
    found: dict[SiteKind, tuple[str, ...]] = {
        "bearing": tuple(b.name for b in machine.bearings),
        "gear": tuple(g.name for g in machine.gears),
        "mesh": tuple(m.name for m in machine.meshes),
        "shaft": tuple(s.name for s in machine.shafts),
    }
    return found | {"body": tuple(b.name for b in machine.bodies)}  # type: ignore[dict-item]


def ends(term: Term) -> list[dict[str, float]]:
    """Defaults, and the severity at either bound."""
    found = [{}, *({p.name: end} for p in term.params if p.name == term.severity for end in (p.low, p.high))]
    return distinct(term, found)


def corners(term: Term) -> list[dict[str, float]]:
    """Defaults; every parameter at either bound, the severity at its default and at its highest."""
    cases: list[dict[str, float]] = [{}]
    for p in term.params:
        cases += [{p.name: p.low}, {p.name: p.high}]
    return distinct(term, [*cases, *severest(term)])


def severest(term: Term) -> list[dict[str, float]]:
    """Defaults, and the severity at either bound; at its highest, every other parameter at either bound."""
    highest = {p.name: p.high for p in term.params if p.name == term.severity}
    others = [p for p in term.params if p.name != term.severity]
    return distinct(term, [*ends(term), *({**highest, p.name: v} for p in others for v in (p.low, p.high))])


def distinct(term: Term, cases: list[dict[str, float]]) -> list[dict[str, float]]:
    """Without those that come to the same values: a bound may be the default."""
    defaults = {p.name: p.default for p in term.params}
    return list({tuple((defaults | case).values()): case for case in cases}.values())


def cases(term: Term) -> list[MachineSpec]:
    """One machine a legal site and end of the severity. All corners at the first and last site of each kind of the
    gearbox, whose gears, shafts and speeds differ; the severest at the first of the kind on other rigid shafts, and on
    the first flexible ones that have it."""
    found = []
    bent: set[SiteKind] = set()
    for name in (*MACHINES, *FLEXIBLE):
        machine = preset(name)
        others = tuple(t for t in machine.terms if t.term != term.key)
        for kind in term.sites:
            legal = [s for s in sites(machine).get(kind, ()) if s in FLEXIBLE.get(name, {s})]
            first = legal[:1] if kind not in bent else []
            if name in FLEXIBLE and legal:
                bent.add(kind)
            tried = {s: severest(term) for s in first}
            if name == MACHINES[0]:
                tried = {s: corners(term) for s in (*legal[:1], *legal[-1:])}
            for site, values in ((s, v) for s in legal for v in tried.get(s, ends(term))):
                spec = TermSpec(term=term.key, site=site, parameters=values)
                found.append(machine.model_copy(update={"terms": (*others, spec)}))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("key", [t.key for t in REGISTRY if t.params])
def test_corners_end_in_signals_or_a_reason(key):
    term = REGISTRY.get(key)
    assert term is not None
    machines = cases(term)
    assert machines, f"{key} can act nowhere on {', '.join((*MACHINES, *FLEXIBLE))}"
    found = simulate_many([Member(machine=m) for m in machines], settings=QUICK, **SPAN)
    assert len(found) == len(machines)
    diverged = []
    for machine, result in zip(machines, found, strict=True):
        where = f"{machine.name} {machine.terms[-1]}"
        if isinstance(result, Response):
            assert np.all(np.isfinite(result.signals)), where
        elif isinstance(result, Diverged | Meaningless):
            diverged.append(where)
        else:
            assert isinstance(result, SpecError), where
            assert all(p.message and p.field for p in result.problems), where
    assert any(isinstance(r, Response) for r in found), f"{key} never runs"
    assert len(diverged) <= max(1, DIVERGENT_SHARE * len(machines)), diverged


def test_the_sweep_would_see_an_illegal_site():
    bad = preset("rotor").model_copy(update={"terms": (TermSpec(term="eccentricity", site="nowhere", parameters={}),)})
    (found,) = simulate_many([Member(machine=bad)], settings=QUICK, **SPAN)
    assert isinstance(found, SpecError)
    assert any("site" in p.field for p in found.problems)
