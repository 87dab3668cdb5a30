"""Plans are reproducible, keys tell what differs, banks survive storage, and failures are said."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reconcile.atlas import keep
from reconcile.atlas.bank import ARRAYS, Bank, Task, tasks
from reconcile.atlas.candidates import Candidate, candidates
from reconcile.atlas.keep import Forgetful, atlas_key, kept_bank
from reconcile.atlas.plan import SLIP, AtlasPlan, Point, at_point, atlas_plan, simulated_at, slips
from reconcile.calibrate.uncertain import uncertain_numbers
from reconcile.observe.statistics import Statistics
from sim.core.errors import SpecError
from sim.core.spec import TorqueLoad
from sim.presets import preset

MACHINE = preset("paper-lightly-damped")
NUMBERS = uncertain_numbers(MACHINE)
CHOSEN = (Candidate(term="outer_spall", site="bearing1"), Candidate(term="unbalance", site="pinion"))
POINT = Point(speed_hz=30.0)
CHANNELS = ("resonator1.y.acceleration",)


def plan(seed: int = 0, chosen=CHOSEN, machine=MACHINE) -> AtlasPlan:  # type: ignore[no-untyped-def]
    return atlas_plan(machine, NUMBERS, chosen, seed=seed, draws=4, pairs=3)


def test_a_plan_is_a_function_of_machine_candidates_and_seed() -> None:
    one, two = plan(), plan()
    assert one.draws == two.draws
    np.testing.assert_array_equal([o.values for o in one.offsets], [o.values for o in two.offsets])
    assert plan(seed=1).draws != one.draws


def test_a_candidates_draws_do_not_depend_on_its_company() -> None:
    alone = [d.term for d in plan(chosen=CHOSEN[1:]).draws if d.candidate is not None]
    assert alone == [d.term for d in plan().draws if d.candidate == CHOSEN[1]]


def test_draws_cover_the_sizes_and_use_the_healthy_machines() -> None:
    found = plan()
    healthy = [d for d in found.draws if d.candidate is None]
    assert [(d.pair, d.twin) for d in healthy] == [(p, twin) for twin in (False, True) for p in range(3)]
    widths = sorted(d.term.parameters["width"] for d in found.draws if d.candidate == CHOSEN[0] and d.term)
    quarters = np.searchsorted(np.geomspace(widths[0] * 0.99, widths[-1] * 1.01, 3), widths)
    assert len(widths) == 4 and set(quarters) == {1, 2}
    member = found.member(found.draws[-1], Point(speed_hz=20.0, torque_ratio=2.0))
    assert member.machine.operating is not None and member.machine.operating.speed_hz == 20.0
    assert member.machine.terms[-1] == found.draws[-1].term
    assert len({found.member(d, POINT).seed for d in healthy}) == len(healthy)


def test_a_point_is_speed_and_load() -> None:
    moved = at_point(MACHINE, Point(speed_hz=12.0, torque_ratio=0.5))
    assert moved.operating is not None and moved.operating.speed_hz == 12.0
    assert [x.torque_nm for x in moved.loads if isinstance(x, TorqueLoad)] == [12.5]
    with pytest.raises(SpecError, match="no speed"):
        at_point(MACHINE.model_copy(update={"operating": None}), POINT)


def test_the_key_changes_with_whatever_the_numbers_depend_on(monkeypatch: pytest.MonkeyPatch) -> None:
    base = atlas_key(plan(), POINT, CHANNELS)
    assert base == atlas_key(plan(), POINT, CHANNELS)
    bearing = MACHINE.bearings[0].model_copy(update={"inner_mass_kg": 0.41})
    other = MACHINE.model_copy(update={"bearings": [bearing, *MACHINE.bearings[1:]]})
    keys = [
        atlas_key(plan(machine=other), POINT, CHANNELS),
        atlas_key(plan(seed=1), POINT, CHANNELS),
        atlas_key(plan(chosen=CHOSEN[:1]), POINT, CHANNELS),
        atlas_key(plan(), Point(speed_hz=30.01), CHANNELS),
        atlas_key(plan(), Point(speed_hz=30.0, torque_ratio=1.1), CHANNELS),
        atlas_key(plan(), POINT, ("resonator2.y.acceleration",)),
    ]
    monkeypatch.setattr(keep, "ATLAS_VERSION", keep.ATLAS_VERSION + 1)
    keys.append(atlas_key(plan(), POINT, CHANNELS))
    monkeypatch.undo()
    monkeypatch.setattr(keep, "PHYSICS_VERSION", "another")
    keys.append(atlas_key(plan(), POINT, CHANNELS))
    assert len({base, *keys}) == len(keys) + 1


def test_a_machine_of_another_name_shares_its_atlas() -> None:
    renamed = MACHINE.model_copy(update={"name": "test rig 7", "notes": "as sent by the customer"})
    assert atlas_key(plan(machine=renamed), POINT, CHANNELS) == atlas_key(plan(), POINT, CHANNELS)


def statistics(k: int) -> Statistics:
    rng = np.random.default_rng(k)
    return Statistics(
        line=rng.uniform(size=(1, 5)),
        floor=rng.uniform(size=(1, 6)),
        total=rng.uniform(size=(1, 6)),
        band=rng.uniform(size=(1, 4)),
        depth=rng.uniform(size=(1, 4, 3)),
        turn=rng.uniform(size=(1, 4, 2)),
        kurtosis=rng.uniform(size=(1, 4)),
        skewness=rng.uniform(size=(1, 4)),
        phase=rng.uniform(size=(1, 3)),
        resolution_hz=1.5,
        duration_s=1.0,
    )


class Shelf(Forgetful):
    """Keeps in a dictionary."""

    def __init__(self) -> None:
        self.kept: dict[str, bytes] = {}

    def get(self, key: str) -> bytes | None:
        return self.kept.get(key)

    def put(self, key: str, data: bytes) -> None:
        self.kept[key] = data


def pretended(_run: object, todo: list[Task]) -> list[list[Statistics | None]]:
    """Statistics that tell the draw's number; draw 4 died."""
    return [[None if k == 4 else statistics(k) for k in task.draws] for task in todo]


def test_tasks_hold_every_draw_once_and_one_effect_each() -> None:
    found = plan()
    todo = tasks(found, POINT, CHANNELS, together=4)
    assert sorted(k for t in todo for k in t.draws) == list(range(len(found.draws)))
    assert all(len(t.draws) <= 4 for t in todo)
    for task in todo:
        assert len({c.term if (c := found.draws[k].candidate) else "" for k in task.draws}) == 1


def test_a_bank_is_in_the_order_of_the_draws_and_is_made_once() -> None:
    shelf, told = Shelf(), []
    first = kept_bank(plan(), POINT, CHANNELS, keeper=shelf, mapper=pretended, made=told.append)  # type: ignore[arg-type]
    second = kept_bank(plan(), POINT, CHANNELS, keeper=shelf, mapper=pretended, made=told.append)  # type: ignore[arg-type]
    assert told == [len(plan().draws)]
    assert first.alive.tolist() == [k != 4 for k in range(len(plan().draws))]
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))
        np.testing.assert_allclose(getattr(first, name)[7], getattr(statistics(7), name), rtol=1e-6)
        assert np.isnan(getattr(first, name)[4]).all()
    part = first.at([7, 2], [0, 0])
    assert part.line.shape == (2, 2, 5)
    np.testing.assert_array_equal(part.line[1, 1], first.line[2, 0])
    again = Bank.from_bytes(part.to_bytes())
    assert (again.resolution_hz, again.duration_s) == (1.5, 1.0)
    np.testing.assert_array_equal(again.depth, part.depth)
    np.testing.assert_array_equal(again.alive, part.alive)


@pytest.mark.parametrize("spoil", [lambda b: b[:200], lambda b: b"", lambda b: b[:99] + bytes(99) + b[198:]])
def test_a_damaged_atlas_is_made_again(spoil: Callable[[bytes], bytes]) -> None:
    shelf, told = Shelf(), []
    first = kept_bank(plan(), POINT, CHANNELS, keeper=shelf, mapper=pretended, made=told.append)  # type: ignore[arg-type]
    whole = dict(shelf.kept)
    shelf.kept = {key: spoil(data) for key, data in whole.items()}
    again = kept_bank(plan(), POINT, CHANNELS, keeper=shelf, mapper=pretended, made=told.append)  # type: ignore[arg-type]
    assert len(told) == 2 and shelf.kept == whole
    np.testing.assert_array_equal(again.line, first.line)


def test_a_machine_that_never_runs_is_said_and_not_kept() -> None:
    shelf = Shelf()
    with pytest.raises(SpecError, match="does not run at this operating point"):
        kept_bank(
            plan(),
            POINT,
            CHANNELS,
            keeper=shelf,
            mapper=lambda _run, todo: [[None] * len(t.draws) for t in todo],
        )
    assert not shelf.kept


def test_cages_of_a_sound_machine_lag_by_another_share_in_every_recording() -> None:
    machine = preset("paper-lightly-damped")
    plan = atlas_plan(machine, uncertain_numbers(machine), candidates(machine)[:2], seed=3)
    point = Point(speed_hz=30.0)
    first = [plan.member(d, point) for d in plan.draws if d.candidate is None and d.pair == 5]
    assert [len(m.machine.terms) for m in first] == [0, 4]
    shares = [t.parameters["share"] for t in first[1].machine.terms]
    assert all(t.term == "cage_slip" for t in first[1].machine.terms) and len(set(shares)) == 4
    assert min(shares) >= 0.0 and max(shares) <= SLIP
    lagging = machine.model_copy(update={"terms": list(first[1].machine.terms[:1])})
    assert {t.site for t in slips(lagging, 3, 5)} == {"bearing2", "bearing3", "bearing4"}


@pytest.mark.parametrize(
    ("speed_hz", "torque", "at"),
    [
        (30.02, 1.0, (30.0, 1.0)),
        (29.86, 0.98, (30.0, 1.0)),
        (30.2, 1.0, (30.2, 1.0)),
        (22.5, 0.96, (22.5, 0.96)),
        (17.337, 1.02, (17.3, 1.0)),
    ],
)
def test_one_atlas_serves_recordings_at_about_one_speed(
    speed_hz: float, torque: float, at: tuple[float, float]
) -> None:
    found = simulated_at(preset("paper-lightly-damped"), Point(speed_hz=speed_hz, torque_ratio=torque))
    assert (found.speed_hz, found.torque_ratio) == at


@given(speed_hz=st.floats(0.5, 500.0))
def test_what_is_simulated_is_never_far_from_what_was_recorded(speed_hz: float) -> None:
    found = simulated_at(preset("paper-lightly-damped"), Point(speed_hz=speed_hz))
    assert found.speed_hz == pytest.approx(speed_hz, rel=0.005001)
    assert simulated_at(preset("paper-lightly-damped"), found) == found
