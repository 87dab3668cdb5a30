"""Sums that are identical by construction, and only those, become one label."""

from fractions import Fraction

import pytest
from gearbox import BASES, INPUT_HZ, KINEMATICS, bearing_hz
from hypothesis import given
from hypothesis import strategies as st

from signals.labels import BearingKinematics, Kinematics, MeshKinematics, merge_lines
from signals.labels.identity import base_vectors, vector_key
from sim.core.errors import SpecError
from sim.core.lines import Line

VECTORS = base_vectors(KINEMATICS)


def line(component: str = "x", mechanism: str = "kinematic", **orders: int) -> Line:
    return Line(orders=tuple(orders.items()), component=component, mechanism=mechanism, family="test")


def same(a: Line, b: Line) -> bool:
    return vector_key(a.orders, VECTORS) == vector_key(b.orders, VECTORS)


def test_mesh_is_teeth_times_shaft() -> None:
    assert same(line(f_m=1), line(f_r1=23))
    assert same(line(f_m=1), line(f_r2=81))
    assert same(line(f_m=1, f_r1=-1), line(f_r1=22))
    assert not same(line(f_m=1, f_r1=-1), line(f_m=1, f_r2=-4))


def test_bearing_ties() -> None:
    assert same(line(f_o1=1), line(f_c1=7))
    assert same(line(f_o1=1, f_i1=1), line(f_r1=7))
    assert same(line(f_o1=3), line(f_o2=3))  # equal bearings on one shaft
    assert same(line(f_b1=2), line(f_b2=2))
    assert not same(line(f_o1=1), line(f_o3=1))
    assert same(line(f_o1=23), line(f_o3=81))  # equal ratio on geared shafts


def test_equal_numbers_are_not_identities() -> None:
    """A bearing whose orders happen to be rational is not tied to the shaft: 4 * f_o = 9 * f_r is a coincidence."""
    ratio = 1 - 2 * 9 / 4 / 7
    bearing = BearingKinematics(index=1, shaft="f_r1", balls=7, diameter_ratio=ratio)
    bases = {"f_r1": 30.0, **bearing_hz(1, 30.0, ratio=ratio)}
    assert 4 * bases["f_o1"] == pytest.approx(9 * 30.0)
    merged = merge_lines([line(f_o1=4), line(f_r1=9)], bases, Kinematics(bearings=(bearing,)))
    assert [c.label for c in merged] == ["9*f_r1", "4*f_o1"] or [c.label for c in merged] == ["4*f_o1", "9*f_r1"]


def test_bearings_that_slip_differently_are_not_merged() -> None:
    bearings = tuple(
        BearingKinematics(index=i, shaft="f_r1", balls=7, diameter_ratio=r) for i, r in ((1, 0.2647), (2, 0.2650))
    )
    vectors = base_vectors(Kinematics(bearings=bearings))
    assert vectors["f_o1"] != vectors["f_o2"]


def test_the_simplest_form_names_the_line() -> None:
    lines = [
        line("input", f_r1=22),
        line("pinion", "eccentricity", f_m=1, f_r1=-1),
        line("bearing2", f_o2=3),
        line("bearing1", f_o1=3),
        line("bearing1", f_c1=21),
    ]
    merged = {c.label: c for c in merge_lines(lines, BASES, KINEMATICS)}
    assert set(merged) == {"1*f_m-1*f_r1", "3*f_o1"}
    sideband = merged["1*f_m-1*f_r1"]
    assert sideband.components == ("pinion", "input")
    assert sideband.mechanisms == ("eccentricity",) and sideband.predicted
    assert sideband.aliases == ("22*f_r1",)
    assert merged["3*f_o1"].components == ("bearing1", "bearing2")


def test_a_terms_own_prediction_names_the_mechanism() -> None:
    merged = merge_lines([line("mesh1", f_m=1), line("mesh1", "mesh_pairs", f_m=1)], BASES, KINEMATICS)
    assert (merged[0].mechanism, merged[0].mechanisms) == ("mesh_pairs", ("mesh_pairs",))


def test_all_multiples_of_a_family_read_alike() -> None:
    """Two terms speak of some multiples and sidebands each; all of the family have both, in one order."""
    lines = [line("bearing1", f_o1=k) for k in range(1, 9)]
    lines += [line("bearing1", "ball_contact", f_o1=k) for k in range(1, 4)]
    lines += [line("bearing1", "fit_clearance", f_o1=k) for k in range(2, 7)]
    lines += [line("gear", f_m=k, f_r2=n) for k in (1, 2) for n in (-1, 1)]
    merged = merge_lines(lines, BASES, KINEMATICS)
    balls = [c for c in merged if c.label.endswith("f_o1")]
    assert len(balls) == 8 and {c.mechanisms for c in balls} == {("fit_clearance", "ball_contact")}
    assert [c.predicted for c in balls] == [True] * 6 + [False] * 2
    assert {c.mechanisms for c in merged if c not in balls} == {("kinematic",)}


def test_negative_sums_fold_and_zero_sums_vanish() -> None:
    merged = merge_lines([line(f_r1=-1, f_m=0), line(f_o1=1, f_c1=-7)], BASES, KINEMATICS)
    assert [(c.label, c.frequency_hz) for c in merged] == [("1*f_r1", INPUT_HZ)]


def test_order_of_writing_does_not_matter() -> None:
    merged = merge_lines([line(f_r1=-1, f_m=1), line(f_m=1, f_r1=-1)], BASES)
    assert [c.label for c in merged] == ["1*f_m-1*f_r1"]


bases = st.sampled_from(sorted(BASES))
sums = st.dictionaries(bases, st.integers(-30, 30), min_size=1, max_size=3)


@given(a=sums, b=sums)
def test_identical_vectors_have_equal_frequencies(a: dict[str, int], b: dict[str, int]) -> None:
    first, second = line(**a), line(**b)
    if same(first, second):
        assert first.frequency_hz(BASES) == pytest.approx(second.frequency_hz(BASES), abs=1e-8)


@given(a=sums, factor=st.integers(2, 5))
def test_vectors_are_linear(a: dict[str, int], factor: int) -> None:
    one = dict(vector_key(tuple(a.items()), VECTORS))
    many = dict(vector_key(tuple((b, factor * n) for b, n in a.items()), VECTORS))
    assert many == {symbol: factor * share for symbol, share in one.items()}


def test_trains_chain_exactly_and_contradictions_are_refused() -> None:
    first = MeshKinematics(base="f_m", pinion_shaft="f_r1", pinion_teeth=23, gear_shaft="f_r2", gear_teeth=81)
    second = MeshKinematics(
        base="f_m2", pinion_shaft="f_r2", pinion_teeth=17, gear_shaft="f_r3", gear_teeth=49, component="mesh2"
    )
    vectors = base_vectors(Kinematics(meshes=(first, second)))
    assert vectors["f_r3"] == {"f_r1": Fraction(23 * 17, 81 * 49)}
    assert vectors["f_m2"] == {"f_r1": Fraction(17 * 23, 81)}
    wrong = MeshKinematics(
        base="f_m3", pinion_shaft="f_r1", pinion_teeth=20, gear_shaft="f_r3", gear_teeth=50, component="mesh3"
    )
    with pytest.raises(SpecError, match=r"mesh[23]: closes a train"):
        base_vectors(Kinematics(meshes=(first, second, wrong)))
