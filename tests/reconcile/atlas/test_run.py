"""Machines of an atlas take longer steps than a user's simulation, and show the same levels."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.atlas import run
from reconcile.atlas.bank import measure, sought
from reconcile.atlas.candidates import with_effects
from reconcile.atlas.run import RATE_HZ, SETTLE_S, SPAN_S, run_members, steps_of
from reconcile.observe.watch import bases_at, watch_list
from sim.assembly.assemble import assemble
from sim.core.errors import TooStiff
from sim.core.response import Response
from sim.core.spec import MachineSpec, TermSpec
from sim.presets import names, preset
from sim.solve.api import simulate
from sim.solve.ensemble import Member
from sim.solve.step_choice import LEAST_STEPS_PER_OUTPUT, steps_per_output

WATCHED = ("resonator1.y.acceleration", "resonator3.y.acceleration")
SAME_DB = 0.1


@pytest.mark.parametrize("name", names())
def test_two_thirds_of_the_steps_and_two_at_least(name: str) -> None:
    system = assemble(preset(name))
    users, here = steps_per_output(system, RATE_HZ), steps_of(system)
    assert LEAST_STEPS_PER_OUTPUT <= here <= users
    assert here == LEAST_STEPS_PER_OUTPUT or 2 * users <= 3 * here < 2 * users + 3


def effects() -> dict[str, MachineSpec]:
    """The gearbox of the paper, sound and with effects that do not rattle."""
    machine = preset("paper")
    spall = TermSpec(term="outer_spall", site="bearing1", parameters={"width": 2e-3})
    crack = TermSpec(term="tooth_crack", site="gear", parameters={"depth": 0.2})
    return {"sound": machine, "spall": with_effects(machine, (spall,)), "crack": with_effects(machine, (crack,))}


@pytest.mark.slow
@pytest.mark.parametrize("effect", ["sound", "spall", "crack"])
def test_levels_are_those_of_a_users_simulation(effect: str) -> None:
    machine = effects()[effect]
    users = simulate(machine, duration_s=SETTLE_S + SPAN_S, output_rate_hz=RATE_HZ, channels=list(WATCHED), seed=3)
    (here,) = run_members([Member(machine=machine, seed=3)], WATCHED)
    assert isinstance(here, Response)
    assert here.quality.steps < users.quality.steps
    watched, bases = watch_list(machine), bases_at(machine, 30.0)
    lines = [measure(r, sought(watched, bases)).line for r in (users, here)]
    clear = lines[0] > 1e-4 * np.nanmax(lines[0], axis=1, keepdims=True)
    assert clear.sum() > 10
    apart = np.abs(10.0 * np.log10(lines[1][clear] / lines[0][clear]))
    assert np.quantile(apart, 0.95) < SAME_DB


@pytest.mark.slow
@pytest.mark.parametrize(
    ("term", "often", "ways"),
    [
        ("fit_clearance", -1.0, ["_one_by_one", "_one_by_one"]),
        ("fit_clearance", 1.0, ["_one_by_one", "_side_by_side"]),
        ("squeeze_film", 0.05, ["_one_by_one", "_side_by_side"]),
        ("pedestal_looseness", -1.0, ["_side_by_side"]),
    ],
)
def test_what_strikes_often_is_simulated_one_by_one(
    monkeypatch: pytest.MonkeyPatch, term: str, often: float, ways: list[str]
) -> None:
    """A film is as stiff as a wall and never strikes, which its first run shows."""
    asked: list[str] = []
    for name in ("_one_by_one", "_side_by_side"):
        way = getattr(run, name)
        monkeypatch.setattr(run, name, lambda *given, way=way, name=name: asked.append(name) or way(*given))
    monkeypatch.setattr(run, "OFTEN", often)
    machine = with_effects(preset("rotor"), (TermSpec(term=term, site="bearing1", parameters={}),))
    found = run_members([Member(machine=machine, seed=k) for k in range(4)], ("disc.y.acceleration",))
    assert all(isinstance(one, Response) for one in found) and len(found) == 4
    assert asked == ways


@pytest.mark.slow
def test_a_ring_that_dry_friction_holds_is_given_up_and_the_others_are_not() -> None:
    """It would take half a minute, and its numbers be refused then."""
    machine = preset("paper-lightly-damped")
    held = TermSpec(
        term="coulomb_friction", site="bearing1", parameters={"force": 10.0, "joint": 0.0, "rest_ratio": 1.9}
    )
    loose = TermSpec(term="fit_clearance_series", site="bearing1", parameters={"gap": 1.1e-5})
    members = [Member(machine=with_effects(machine, terms), seed=1) for terms in ((loose,), (held, loose), (loose,))]
    first, given_up, last = run_members(members, WATCHED)
    assert isinstance(given_up, TooStiff) and given_up.time_s < 0.3 * (SETTLE_S + SPAN_S)
    assert isinstance(first, Response) and isinstance(last, Response)
    assert np.array_equal(first.signals, last.signals)
