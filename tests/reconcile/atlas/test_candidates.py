"""Candidates are the registered effects, everywhere they may act, in sizes their terms allow."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.atlas.candidates import FREE, Candidate, candidates, draw_term, size_parameter, size_range, with_effects
from reconcile.atlas.plan import Point, atlas_plan, side_by_side, with_tooth_pairs
from reconcile.calibrate.uncertain import uncertain_numbers
from sim.assembly.assemble import BUILT_IN, assemble
from sim.core.spec import MachineSpec, TermSpec
from sim.parts.wall import SOUGHT_DAMPING, SOUGHT_FRICTION_SPEED
from sim.presets import preset
from sim.terms import REGISTRY

MACHINE = with_tooth_pairs(preset("paper-lightly-damped"))
ALL = candidates(MACHINE)
SIZED = [t for t in REGISTRY if t.severity is not None and t.key not in BUILT_IN and t.key not in FREE]
PARTS = {
    "bearing": [b.name for b in MACHINE.bearings],
    "gear": [g.name for g in MACHINE.gears],
    "body": [b.name for b in MACHINE.bodies],
    "mesh": [m.name for m in MACHINE.meshes],
    "shaft": [s.name for s in MACHINE.shafts],
}


@pytest.mark.parametrize("term", SIZED, ids=lambda t: t.key)
def test_every_effect_with_a_size_stands_at_each_legal_site(term) -> None:  # type: ignore[no-untyped-def]
    sites = {c.site for c in ALL if c.term == term.key}
    assert sites == {name for kind in term.sites for name in PARTS[kind]}


def having(term: str, site: str, **parameters: float) -> MachineSpec:
    return MACHINE.model_copy(update={"terms": [TermSpec(term=term, site=site, parameters=parameters)]})


def test_nothing_stands_twice_and_what_is_ruled_out_is_no_candidate() -> None:
    assert len({c.label for c in ALL}) == len(ALL)
    assert not {c.term for c in ALL} & set(FREE)
    left = {c.label for c in candidates(having("fit_clearance", "bearing1", gap=2e-5))}
    assert "fit_clearance@bearing1" in left
    gone = {c.label for c in ALL} - left
    assert gone and all(REGISTRY.get(g.split("@")[0]) is not None and g.endswith("@bearing1") for g in gone)
    assert "fit_clearance_series@bearing1" in gone
    none = {c.label for c in candidates(having("fit_clearance", "bearing1", gap=0.0))}
    assert "fit_clearance@bearing1" not in none


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_what_the_machine_has_grows_from_what_it_is(share: float) -> None:
    machine = having("fit_clearance", "bearing1", gap=2e-5, friction=0.07)
    grown = draw_term(Candidate(term="fit_clearance", site="bearing1"), share, np.random.default_rng(1), machine)
    assert grown.parameters == {"gap": pytest.approx(2e-5 * 6.0**share), "friction": 0.07}
    other = draw_term(Candidate(term="fit_clearance", site="bearing2"), share, np.random.default_rng(1), machine)
    assert other.site == "bearing2" and other.parameters["friction"] != 0.07


def test_a_small_effect_of_the_file_does_not_hide_a_large_one() -> None:
    """A residual unbalance is in every file that knows of it."""
    machine = having("unbalance", "pinion", moment=1e-5)
    candidate = Candidate(term="unbalance", site="pinion")
    most = draw_term(candidate, 1.0, np.random.default_rng(1), machine).parameters["moment"]
    assert most == pytest.approx(draw_term(candidate, 1.0, np.random.default_rng(1), MACHINE).parameters["moment"])
    least = draw_term(candidate, 0.0, np.random.default_rng(1), machine).parameters["moment"]
    assert least == pytest.approx(1e-5)


def test_what_cannot_grow_is_no_candidate() -> None:
    full = having("pedestal_looseness", "bearing1", loss=0.99)
    assert "pedestal_looseness@bearing1" not in {c.label for c in candidates(full)}


def test_of_effects_side_by_side_the_largest_grows_and_the_others_stay() -> None:
    modes = [
        TermSpec(term="support_mode", site="bearing1", parameters={"axis": axis, "mass": mass})
        for axis, mass in ((0.0, 0.2), (1.0, 0.4))
    ]
    machine = MACHINE.model_copy(update={"terms": modes})
    candidate = Candidate(term="support_mode", site="bearing1")
    assert candidate in candidates(machine)
    drawn = draw_term(candidate, 0.5, np.random.default_rng(1), machine)
    grown = with_effects(machine, [drawn]).terms
    assert drawn.parameters["axis"] == 1.0 and len(grown) == 2 and modes[0] in grown


def test_a_grown_effect_stands_in_place_of_the_old_one() -> None:
    machine = having("fit_clearance", "bearing1", gap=2e-5)
    grown = TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": 5e-5})
    pit = TermSpec(term="outer_spall", site="bearing1", parameters={"width": 1e-3})
    assert with_effects(machine, [grown]).terms == [grown]
    assert with_effects(machine, [pit]).terms == [*machine.terms, pit]
    assemble(with_effects(machine, [grown, pit]))


def test_faint_forms_stand_only_where_the_machine_has_no_such_effect() -> None:
    """Else the old one would be taken away beside an effect elsewhere."""
    machine = having("outer_spall", "bearing1", width=1e-3)
    chosen = [c for c in candidates(machine) if c.term == "outer_spall"]
    plan = side_by_side(atlas_plan(machine, uncertain_numbers(machine), chosen, seed=0, draws=2, pairs=2))
    effects = [d for d in plan.draws if d.term is not None]
    assert {t.site for d in effects for t in d.beside} == {"bearing2", "bearing3", "bearing4"}
    there = [plan.member(d, Point(speed_hz=30.0)).machine.terms for d in effects]
    assert all(len([t for t in terms if t.site == "bearing1"]) == 1 for terms in there)


@pytest.mark.parametrize(
    "candidate",
    [next(c for c in ALL if c.term == t.key) for t in SIZED if any(c.term == t.key for c in ALL)],
    ids=lambda c: c.term,
)
def test_draws_are_within_bounds_reproducible_and_leave_out_what_the_machine_gives(candidate: Candidate) -> None:
    term = REGISTRY.get(candidate.term)
    assert term is not None
    size = size_parameter(term)
    low, high = size_range(size)
    assert 0 < low < high <= size.high
    searched = {p.name: p for p in term.params if p.sought is not None and p is not size}
    given = set(term.machine_values(MACHINE, candidate.site)) - {size.name} - set(searched)
    for k in range(30):
        share = k / 29
        one, two = (draw_term(candidate, share, np.random.default_rng(k), MACHINE) for _ in range(2))
        assert one == two
        assert low * (1 - 1e-9) <= one.parameters[size.name] <= high * (1 + 1e-9)
        assert not given & set(one.parameters)
        assert set(searched) <= set(one.parameters)
        values = term.values(one.parameters, candidate.label)
        for param in term.params:
            if param.choices:
                assert values[param.name] in param.choices


def test_larger_shares_are_larger_sizes() -> None:
    sizes = [
        draw_term(Candidate(term="outer_spall", site="bearing1"), u, np.random.default_rng(0), MACHINE).parameters[
            "width"
        ]
        for u in (0.0, 0.5, 1.0)
    ]
    assert sizes[1] == pytest.approx(np.sqrt(sizes[0] * sizes[2]))
    assert sizes[0] < sizes[1] < sizes[2]


@pytest.mark.parametrize(
    ("name", "bounds"), [("damping", SOUGHT_DAMPING), ("friction_speed", SOUGHT_FRICTION_SPEED)], ids=str
)
def test_what_no_drawing_says_of_a_bore_is_searched_though_the_machine_states_it(
    name: str, bounds: tuple[float, float]
) -> None:
    assert MACHINE.bearings[0].bore_damping_ns_per_m is not None
    fit = Candidate(term="fit_clearance", site="bearing1")
    low, high = (
        draw_term(fit, 0.5, np.random.default_rng(0), MACHINE, sought={name: share}).parameters[name]
        for share in (0.0, 1.0)
    )
    assert (low, high) == pytest.approx(bounds)
    plan = atlas_plan(MACHINE, uncertain_numbers(MACHINE), [fit], seed=0)
    drawn = [d.term.parameters[name] for d in plan.draws if d.term is not None]
    places = np.sort(np.log(np.array(drawn) / low) / np.log(high / low))
    assert places == pytest.approx((np.arange(len(drawn)) + 0.5) / len(drawn))


def test_what_is_searched_beside_the_size_goes_in_orders_of_its_own() -> None:
    fit = Candidate(term="fit_clearance_series", site="bearing1")
    plan = atlas_plan(MACHINE, uncertain_numbers(MACHINE), [fit], seed=0)
    names = ("gap", "damping", "friction_speed")
    orders = [tuple(np.argsort([d.term.parameters[n] for d in plan.draws if d.term is not None])) for n in names]
    assert len(set(orders)) == len(names)
    assert all(order != other[::-1] for order in orders for other in orders)


def test_unknown_terms_and_terms_without_size_are_refused() -> None:
    with pytest.raises(ValueError, match="no term"):
        draw_term(Candidate(term="gremlin", site="bearing1"), 0.5, np.random.default_rng(0), MACHINE)
    unsized = next((t for t in REGISTRY if t.severity is None), None)
    if unsized is not None:
        with pytest.raises(ValueError, match="no size"):
            size_parameter(unsized)


@pytest.mark.slow
def test_tooth_pairs_let_single_teeth_differ() -> None:
    nominal = preset("paper")
    paired = with_tooth_pairs(nominal)
    assert all(m.table is None and m.tooth_pairs for m in paired.meshes)
    assert paired.model_copy(update={"meshes": nominal.meshes}) == nominal
    crack = draw_term(Candidate(term="tooth_crack", site="pinion"), 0.5, np.random.default_rng(0), paired)
    assemble(paired.model_copy(update={"terms": [*paired.terms, crack]}), seed=0)
