"""A law stands where it brings the change and no known effect does; else a place and no law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.judge.screen import judge
from reconcile.judge.space import Library, fit_space
from reconcile.machine import unknown
from reconcile.machine.laws import SHARES, Motion, TrialLaw
from reconcile.machine.library import Catalogued
from reconcile.machine.setting import Found
from reconcile.machine.unknown import at_supports, likely_supports, unknown_force
from reconcile.machine.words import law_sentence
from sim import presets
from sim.core.errors import Problem, SpecError
from sim.core.spec import TermSpec
from tests.reconcile.judge.made import EFFECTS, changes, library, world

MADE = world()
NAMES = ("coulomb_friction@bearing2", "rub@gear", "unbalance@pinion")
MOTION = Motion(x=np.array([-1e-6, 1e-6]), v=np.array([-2e-3, 2e-3]), stiffness_n_per_m=6e7)
TERM = TermSpec(term="custom_force", site="bearing2", parameters={"law": 1.0})


def setting_for(observed: np.ndarray) -> tuple[SimpleNamespace, Found]:
    """Three effects are known, the fourth of the made world is the law's."""
    here, made, machine = changes(MADE, observed), library(MADE), presets.preset("paper-lightly-damped")
    known = Library(
        changes=made.changes[:36],
        groups={name: made.groups[effect] for name, effect in zip(NAMES, EFFECTS[:3], strict=True)},
        shares=made.shares[:36],
    )
    fitted = fit_space(here, known, seed=1)
    found = Found(
        known=Catalogued(library=known, terms=(TERM,) * 36),
        fitted=fitted,
        fine=fit_space(here, known, seed=1, view=here.single),
        screen=judge((fitted,), observed, {}, 1.0),
    )
    return SimpleNamespace(changes=here, machine=machine, fitted_machine=machine, seed=1), found


def rows_of(_setting: object, _moving: object, law: TrialLaw, site: str, _mapper: object) -> Catalogued | None:
    """Draws of the fourth effect for one law at one place; no other law runs."""
    if (law.key, site) != ("drag", "bearing2"):
        return None
    made = library(MADE, seed=4)
    rows = list(made.groups[EFFECTS[3]])
    own = Library(changes=made.changes[rows], groups={f"drag@{site}": tuple(range(12))}, shares=made.shares[rows])
    return Catalogued(library=own, terms=(TERM,) * 12)


def moving(_machine: object, sites: tuple[str, ...], _seed: int) -> Mapping[str, Motion]:
    return dict.fromkeys(sites, MOTION)


@pytest.fixture(autouse=True)
def _no_simulations(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unknown, "_rows", rows_of)
    monkeypatch.setattr(unknown, "motions", moving)


def seen(effect: int, seed: int = 3) -> np.ndarray:
    rng = np.random.default_rng([8, seed])
    return MADE.effect(effect, 0.6, rng) + MADE.noise(rng)


def test_the_law_that_brings_the_change_stands() -> None:
    setting, found = setting_for(seen(3))
    told = unknown_force(setting, found, 4, map)  # type: ignore[arg-type]
    assert told is not None and told.label == "drag@bearing2" and told.force.site == "bearing2"
    assert law_sentence(told.force, tried=True).startswith("A force at bearing2 brings it about")
    assert told.force.law is not None and "|dz/dt| dz/dt" in told.force.law
    force, argument = (np.array(told.force.samples[k]) for k in ("force_n", "velocity_m_per_s"))
    assert np.allclose(force, told.force.coefficients["drag"] * np.abs(argument) * argument)
    assert np.all(np.array(told.force.samples["low_n"]) <= force)
    assert np.all(force <= np.array(told.force.samples["high_n"]))
    shares = [MOTION.coefficient(next(w for w in unknown.LAWS if w.key == "drag"), s) for s in SHARES]
    assert min(shares) < told.force.coefficients["drag"] < max(shares)
    assert told.change is not None and told.change.shape == setting.changes.observed.shape
    assert told.machine is not None and [w.dof for w in told.machine.custom_laws] == [
        "bearing2.outer.x",
        "bearing2.outer.y",
    ]


def test_a_change_that_a_known_effect_brings_gets_no_law() -> None:
    setting, found = setting_for(seen(0))
    told = unknown_force(setting, found, 4, map)  # type: ignore[arg-type]
    assert told is not None and told.force.law is None and told.known is None and told.machine is None


def test_a_change_that_nothing_brings_gets_a_place_alone() -> None:
    setting, found = setting_for(np.random.default_rng(2).normal(0.0, 9.0, changes(MADE, seen(0)).observed.size))
    told = unknown_force(setting, found, 4, map)  # type: ignore[arg-type]
    assert told is not None and told.force.law is None and told.force.site.startswith("bearing")


def test_quick_tries_no_law_and_a_machine_that_does_not_run_gets_none(monkeypatch: pytest.MonkeyPatch) -> None:
    setting, found = setting_for(seen(3))
    quick = unknown_force(setting, found, 0, map)  # type: ignore[arg-type]
    assert quick is not None and quick.force.law is None and not quick.tried
    assert "full budget" in law_sentence(quick.force, tried=quick.tried)

    def refuse(*_args: object) -> None:
        raise SpecError(Problem(field="machine", message="does not run"))

    monkeypatch.setattr(unknown, "motions", refuse)
    told = unknown_force(setting, found, 4, map)  # type: ignore[arg-type]
    assert told is not None and told.force.law is None


def test_without_single_lines_nothing_is_tried() -> None:
    setting, found = setting_for(seen(3))
    assert unknown_force(setting, replace(found, fine=None), 4, map) is None  # type: ignore[arg-type]


def test_supports_are_ordered_by_what_acts_there() -> None:
    setting, found = setting_for(seen(0))
    assert likely_supports(setting, found)[0] == "bearing2"  # type: ignore[arg-type]


def test_the_place_of_an_unknown_force_is_told_among_supports() -> None:
    weights = {"missing_tooth@gear": 0.5, "outer_spall@bearing4": 0.2, "ring_creep@bearing4": 0.1, "rub@pinion": 0.2}
    found = at_supports(weights, "bearing4", ["bearing1", "bearing4"])
    assert {name.split("@")[1] for name in found} == {"bearing4"}
    assert sum(found.values()) == pytest.approx(1.0)
    assert at_supports({"rub@pinion": 1.0}, "bearing1", ["bearing1"])["force@bearing1"] == pytest.approx(1.0)


def test_the_place_where_a_law_stands_leads() -> None:
    weights = {"outer_spall@bearing2": 0.6, "outer_spall@bearing1": 0.2}
    found = at_supports(weights, "bearing1", ["bearing1", "bearing2"])
    one = found["outer_spall@bearing1"] + found["force@bearing1"]
    assert one > found["outer_spall@bearing2"] > 0.48 and sum(found.values()) == pytest.approx(1.0)
