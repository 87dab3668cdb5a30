"""Sizes by levels: which machines are simulated for them, and what made ones tell."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.candidates import sought_range
from reconcile.atlas.plan import AtlasPlan, Draw, Point, with_tooth_pairs
from reconcile.calibrate.uncertain import Offsets
from reconcile.machine import level_size
from reconcile.machine.level_size import BEYOND, DRAWS, STRIKING, WIDER, by_levels
from reconcile.machine.meter import Meter
from reconcile.machine.refine import known_term
from reconcile.machine.setting import Found
from reconcile.machine.severity import estimated_severity
from sim.core.errors import Problem, SpecError
from sim.core.spec import TermSpec
from sim.presets import preset
from tests.reconcile.judge.made import FEATURES
from tests.reconcile.machine.rubs import MADE, MEMBERS, RIGHT, found_in

PAPER = with_tooth_pairs(preset("paper"))
METER = Meter(map)


def asked(
    monkeypatch: pytest.MonkeyPatch, size: float, *, runs: bool = True
) -> tuple[SimpleNamespace, Found, list[Draw]]:
    """A machine of the made world that has the effect in this size, and the draws that were asked for."""
    rng = np.random.default_rng(int(size) % 97)
    seen = MADE.change(RIGHT, np.array([0.005, -0.008, 0.003]), size) + rng.normal(0, 1, FEATURES)
    setting, found = found_in(seen)
    healthy = tuple(Draw(pair=k) for k in range(MEMBERS))
    offsets = tuple(Offsets(values=0.25 * o.values) for o in setting.plan.offsets)  # they agree with a baseline
    setting.plan = AtlasPlan(machine=PAPER, numbers=(), offsets=offsets, twins=offsets, draws=healthy, seed=5)
    setting.fitted_machine, setting.banks, setting.seen_through = PAPER, (), ()
    told: list[Draw] = []

    def simulated(_setting, plan, _mapper):  # type: ignore[no-untyped-def]
        told.extend(plan.draws)
        return ()

    def listed(plan, _banks, _seen, _rest, _healthy, *, with_baseline):  # type: ignore[no-untyped-def]
        assert with_baseline
        if not runs:
            raise SpecError(Problem(field="machine", message="does not run", allowed="one that does"))
        moved = [plan.offsets[d.pair].values for d in plan.draws]
        return MADE.catalogue(RIGHT, moved, [d.term for d in plan.draws])

    monkeypatch.setattr(level_size, "simulated_banks", simulated)
    monkeypatch.setattr(level_size, "catalogued", listed)
    monkeypatch.setattr(level_size, "_worth", lambda *_: DRAWS)
    return setting, found, told


@pytest.mark.parametrize("size", [3e6, 1.2e7, 4e7])
def test_the_size_of_made_machines_is_found(monkeypatch: pytest.MonkeyPatch, size: float) -> None:
    setting, found, told = asked(monkeypatch, size)
    sizes = by_levels(setting, found, [RIGHT, "unbalance@gear"], METER)  # type: ignore[arg-type]
    assert list(sizes) == [RIGHT] and len(told) in (DRAWS, DRAWS + DRAWS // 2)
    assert sizes[RIGHT].value == pytest.approx(size, rel=0.4) and sizes[RIGHT].low < size < sizes[RIGHT].high


def test_sizes_go_evenly_over_more_than_was_left_open_each_on_another_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    setting, found, told = asked(monkeypatch, 1e7)
    by_levels(setting, found, [RIGHT], METER)  # type: ignore[arg-type]
    levels = estimated_severity(found.view(RIGHT), found.known, RIGHT, setting.changes.observed)
    least, most = sought_range(PAPER, known_term("rub"), "gear")
    low, high = max(levels.low / WIDER, least), min(levels.high * WIDER, most)
    logs = np.log([d.term.parameters["stiffness"] for d in told[:DRAWS] if d.term is not None])
    assert np.diff(logs) == pytest.approx(np.log(high / low) / DRAWS)
    assert logs[0] == pytest.approx(np.log(low) + 0.5 * np.log(high / low) / DRAWS)
    pairs = [d.pair for d in told]
    assert len(set(pairs[:MEMBERS])) == MEMBERS, "no machine twice before all have been"
    again, once_more, other = asked(monkeypatch, 1e7)
    by_levels(again, once_more, [RIGHT], METER)  # type: ignore[arg-type]
    assert other == told, "the same seed asks for the same machines"


def test_sizes_go_on_beyond_an_end_where_the_size_may_lie_there(monkeypatch: pytest.MonkeyPatch) -> None:
    """The nearest draws are made to leave too small sizes open."""
    setting, found, told = asked(monkeypatch, 3e7)
    small = replace(
        estimated_severity(found.view(RIGHT), found.known, RIGHT, setting.changes.observed), low=4e6, high=9e6
    )
    monkeypatch.setattr(level_size, "estimated_severity", lambda *_: small)
    size = by_levels(setting, found, [RIGHT], METER)[RIGHT]  # type: ignore[arg-type]
    assert len(told) == DRAWS + DRAWS // 2
    further = [d.term.parameters["stiffness"] for d in told[DRAWS:] if d.term is not None]
    assert min(further) > 9e6 * WIDER and max(further) < 9e6 * WIDER * BEYOND
    assert size.value == pytest.approx(3e7, rel=0.4) and size.low < 3e7 < size.high


def test_nothing_is_simulated_where_no_machine_agrees_with_a_baseline_or_the_effect_strikes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    setting, found, told = asked(monkeypatch, 1e7)
    for one, names in (
        (SimpleNamespace(**{**vars(setting), "fitted_machine": None}), [RIGHT]),
        (SimpleNamespace(**{**vars(setting), "changes": replace(setting.changes, with_baseline=False)}), [RIGHT]),
        (setting, ["outer_spall@bearing1"]),
        (setting, []),
    ):
        assert by_levels(one, found, names, METER) == {}  # type: ignore[arg-type]
    assert told == []


def test_no_size_is_told_where_no_machine_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    setting, found, _ = asked(monkeypatch, 1e7, runs=False)
    assert by_levels(setting, found, [RIGHT], METER) == {}  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("key", "site", "values", "many"),
    [
        ("tooth_friction", "mesh1", {"coefficient": 0.05}, DRAWS),
        ("pedestal_looseness", "bearing1", {"loss": 0.5}, DRAWS),
        ("fit_clearance", "bearing1", {"gap": 2e-5}, STRIKING),
        ("fit_clearance_series", "bearing1", {"gap": 2e-5, "stiffness": 1e10}, 0),
    ],
)
def test_what_costs_more_gets_fewer_sizes(key: str, site: str, values: dict[str, float], many: int) -> None:
    still = (Offsets(values=np.zeros(0)),)
    plan = AtlasPlan(machine=PAPER, numbers=(), offsets=still, twins=still, draws=(), seed=1)
    setting = SimpleNamespace(plan=plan, machine=PAPER, data=(SimpleNamespace(point=Point(speed_hz=30.0)),))
    term = known_term(key)
    rest = {p.name: p.default for p in term.params if not p.choices}
    spec = TermSpec(term=key, site=site, parameters={**rest, **{k: v for k, v in values.items() if k in rest}})
    assert level_size._worth(setting, [spec]) == many  # type: ignore[arg-type]
