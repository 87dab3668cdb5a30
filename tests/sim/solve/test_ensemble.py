"""Eight machines side by side against the single solver, and against themselves in other company."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import Cancelled, Diverged, SpecError, TooStiff, UnknownName
from sim.core.response import Response
from sim.core.spec import MachineSpec, TermSpec
from sim.presets import PRESETS, preset
from sim.solve.api import simulate
from sim.solve.ensemble import Member, simulate_many
from sim.solve.settings import Settings
from tests.strategies.systems import with_terms

QUICK = Settings(estimate_error=False)
SHORT = {"duration_s": 0.03, "output_rate_hz": 20_000.0}
REGULAR_TOLERANCE = 1e-9


def stiffer(machine: MachineSpec, factor: float) -> MachineSpec:
    data = machine.model_dump()
    for bearing in data["bearings"]:
        bearing["support"]["stiffness_y_n_per_m"] *= factor
    return MachineSpec.model_validate(data)


def same(one: Response, other: Response, tolerance: float) -> None:
    kinds = [(c.quantity, c.unit) for c in other.channels]
    largest = np.max(np.abs(other.signals), axis=1)
    # a channel that only hums with rounding is measured by the largest of its kind
    size = np.array([max(v for v, k in zip(largest, kinds, strict=True) if k == kind) for kind in kinds])[:, None]
    size = np.maximum(size, 1e-8)  # what never moves differs by rounding only
    apart = np.abs(one.signals - other.signals) > tolerance * size
    states = np.array([c.quantity == "state" for c in other.channels])
    assert not np.any(apart[~states])
    # a ball that just touches may count or not, by rounding
    assert apart[states].mean() < 0.01 if np.any(states) else True
    assert one.quality.steps == other.quality.steps
    assert one.quality.refined_steps == other.quality.refined_steps
    assert one.contact_share == pytest.approx(other.contact_share)
    assert one.quality.energy.residual_j == pytest.approx(
        other.quality.energy.residual_j, abs=1e-9 * other.quality.energy.scale_j
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(PRESETS))
def test_a_lane_equals_the_single_solver(name):
    machine = preset(name)
    single = simulate(machine, settings=QUICK, channels=("all",), **SHORT)
    (lane,) = simulate_many([Member(machine=machine)], settings=QUICK, channels=("all",), **SHORT)
    assert isinstance(lane, Response)
    same(lane, single, REGULAR_TOLERANCE)
    assert [c.name for c in lane.channels] == [c.name for c in single.channels]
    assert lane.warnings == single.warnings


@pytest.mark.slow
def test_every_lane_is_its_own_machine():
    machines = [stiffer(preset("paper-demo"), 0.7 + 0.1 * k) for k in range(8)]
    lanes = simulate_many([Member(machine=m) for m in machines], settings=QUICK, **SHORT)
    for machine, lane in zip(machines, lanes, strict=True):
        assert isinstance(lane, Response)
        same(lane, simulate(machine, settings=QUICK, **SHORT), REGULAR_TOLERANCE)


@pytest.mark.slow
def test_the_same_bytes_alone_in_any_order_beside_any_others():
    mine = Member(machine=stiffer(preset("paper-demo"), 1.03))
    others = [Member(machine=stiffer(preset("paper-demo"), f)) for f in (0.5, 0.9, 2.0, 1.4)]
    # a loose ring in light load rattles: its lane refines while the others wait
    rattling = preset("paper-demo").model_copy(
        update={"terms": (TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": 3e-4}),)}
    )
    every: dict[str, Any] = {**SHORT, "settings": QUICK, "channels": ("all",)}
    lonely = simulate_many([mine], **every)[0]
    first = simulate_many([mine, *others], **every)[0]
    last = simulate_many([*others, Member(machine=rattling), mine], **every)[-1]
    for found in (first, last):
        assert isinstance(lonely, Response)
        assert isinstance(found, Response)
        np.testing.assert_array_equal(found.signals, lonely.signals)
        assert found.quality == lonely.quality


@pytest.mark.slow
def test_structures_may_be_mixed_and_come_back_in_order():
    names = ["rotor", "paper", "gear-pair", "paper", "oscillator"]
    found = simulate_many([Member(machine=preset(n)) for n in names], settings=QUICK, **SHORT)
    assert [r.machine.name for r in found if isinstance(r, Response)] == [preset(n).name for n in names]
    np.testing.assert_array_equal(found[1].signals, found[3].signals)  # type: ignore[union-attr]


def test_seeds_belong_to_members():
    term = TermSpec(term="pitch_error", site="pinion", parameters={"rms": 5e-6})
    machine = preset("paper").model_copy(update={"terms": (term,)})
    one, other, again = simulate_many([Member(machine=machine, seed=s) for s in (1, 2, 1)], settings=QUICK, **SHORT)
    assert isinstance(one, Response)
    assert np.array_equal(one.signals, again.signals)  # type: ignore[union-attr]
    assert not np.array_equal(one.signals, other.signals)  # type: ignore[union-attr]
    same(one, simulate(machine, seed=1, settings=QUICK, **SHORT), REGULAR_TOLERANCE)


def test_an_impossible_member_leaves_its_error():
    bad = preset("paper").model_copy(update={"terms": (TermSpec(term="nothing", site="pinion", parameters={}),)})
    good = preset("paper")
    found = simulate_many([Member(machine=bad), Member(machine=good)], settings=QUICK, **SHORT)
    assert isinstance(found[0], SpecError)
    assert isinstance(found[1], Response)
    named = simulate_many([Member(machine=good)], settings=QUICK, channels=("nowhere.x.velocity",), **SHORT)
    assert isinstance(named[0], UnknownName)


def test_a_diverging_member_leaves_its_error_and_spares_the_others():
    data = preset("oscillator").model_dump()
    data["loads"][0]["constant_n"] = 1e9
    runaway = MachineSpec.model_validate(data)
    assert runaway != preset("oscillator")
    found = simulate_many([Member(machine=runaway), Member(machine=preset("oscillator"))], settings=QUICK, **SHORT)
    assert isinstance(found[0], Diverged)
    assert isinstance(found[1], Response)
    same(found[1], simulate(preset("oscillator"), settings=QUICK, **SHORT), REGULAR_TOLERANCE)


@pytest.mark.slow
def test_a_costly_member_is_given_up_alone_as_by_the_single_solver():
    """Dry friction that holds a loose ring in its seat, beside the same with hardly any."""
    asked = {"duration_s": 0.4, "output_rate_hz": 20_480.0, "channels": ("resonator1.y.acceleration",)}
    held, free = (
        with_terms(
            preset("paper-lightly-damped"),
            TermSpec(
                term="coulomb_friction",
                site="bearing1",
                parameters={"force": force, "joint": 0.0, "rest_ratio": 1.9},
            ),
            TermSpec(term="fit_clearance_series", site="bearing1", parameters={"gap": 1.1e-5}),
        )
        for force in (10.0, 0.5)
    )
    settings = Settings(estimate_error=False, steps_per_output=3, rtol=1e-2, most_iterations=4.0)
    costly, cheap = simulate_many([Member(machine=held), Member(machine=free)], settings=settings, **asked)
    assert isinstance(costly, TooStiff) and isinstance(cheap, Response)
    with pytest.raises(TooStiff) as caught:
        simulate(held, settings=settings, **asked)
    # a piece of the run apart at most: what a ring that sticks takes hangs on the last bit, so on the processor
    assert caught.value.time_s == pytest.approx(costly.time_s, abs=0.0042)
    assert costly.time_s < 0.01
    assert simulate(free, settings=settings, **asked).signals.shape == cheap.signals.shape


@pytest.mark.slow
def test_step_error_is_the_single_solvers():
    machine = preset("paper-demo")
    (lane,) = simulate_many([Member(machine=machine)], **SHORT)
    assert isinstance(lane, Response)
    single = simulate(machine, **SHORT)
    assert lane.quality.step_error == pytest.approx(single.quality.step_error, rel=1e-4)
    assert lane.quality.step_error_kind == single.quality.step_error_kind


def test_instantaneous_values():
    settings = Settings(estimate_error=False, anti_alias=False, steps_per_output=2)
    machine = preset("rotor")
    (lane,) = simulate_many([Member(machine=machine)], settings=settings, **SHORT)
    assert isinstance(lane, Response)
    same(lane, simulate(machine, settings=settings, **SHORT), REGULAR_TOLERANCE)


@pytest.mark.slow
def test_progress_and_cancelling():
    members = [Member(machine=preset("rotor"))] * 17
    seen: list[float] = []
    simulate_many(members, settings=QUICK, progress=seen.append, **SHORT)
    assert seen == pytest.approx([1 / 3, 2 / 3, 1.0])
    with pytest.raises(Cancelled):
        simulate_many(members, settings=QUICK, cancelled=lambda: True, **SHORT)


def test_an_impossible_request_is_refused():
    with pytest.raises(SpecError):
        simulate_many([Member(machine=preset("rotor"))], duration_s=-1.0, output_rate_hz=20_000.0)
    assert simulate_many([], **SHORT) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", ["paper-demo", "rotor"])
def test_the_pilot_is_the_beginning_of_the_run(name):
    """Unfiltered runs draw jumps otherwise than a pilot does and have one of their own: it says the same."""
    members = [Member(machine=stiffer(preset(name), 1.0 + 0.1 * k)) for k in range(2)]
    heard = simulate_many(members, duration_s=0.08, output_rate_hz=20_000.0)
    own = simulate_many(members, duration_s=0.08, output_rate_hz=20_000.0, settings=Settings(anti_alias=False))
    single = simulate(members[1].machine, duration_s=0.08, output_rate_hz=20_000.0)
    for one, other in zip(heard, own, strict=True):
        assert isinstance(one, Response)
        assert isinstance(other, Response)
        assert one.quality.step_error == other.quality.step_error
        assert one.quality.steps > other.quality.steps  # of the filter's tail only
    assert heard[1].quality.step_error == pytest.approx(single.quality.step_error, rel=1e-3)  # type: ignore[union-attr]
    same(heard[1], single, REGULAR_TOLERANCE)  # type: ignore[arg-type]


def test_a_system_at_hand_is_not_assembled_again():
    machine = preset("rotor")
    at_hand = Member(machine=machine, seed=3, system=assemble(machine, seed=3))
    one, other = simulate_many([at_hand, Member(machine=machine, seed=3)], settings=QUICK, **SHORT)
    np.testing.assert_array_equal(one.signals, other.signals)  # type: ignore[union-attr]
