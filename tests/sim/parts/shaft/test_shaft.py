"""Sections, nodes and beam elements against closed forms."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.core.spec import ShaftSegment, ShaftSpec
from sim.parts.shaft import (
    beam_element,
    section,
    shaft_length_m,
    shaft_nodes,
    shear_factor,
    torsional_stiffness_nm_per_rad,
)

STEPPED = ShaftSpec(
    name="s",
    segments=[ShaftSegment(length_m=0.1, diameter_m=0.03), ShaftSegment(length_m=0.2, diameter_m=0.05, bore_m=0.02)],
    seats={"a": 0.05, "b": 0.1, "c": 0.25},
)


def test_shear_factor_of_solid_and_thin_walled_sections():
    """Cowper 1966: 6 (1 + nu)/(7 + 6 nu) for the circle, 2 (1 + nu)/(4 + 3 nu) for the thin tube."""
    assert shear_factor(0.3) == pytest.approx(7.8 / 8.8)
    assert shear_factor(0.3, 1.0) == pytest.approx(2.6 / 4.9)


def test_nodes_stand_at_ends_seats_and_steps_and_none_is_doubled():
    nodes = shaft_nodes(STEPPED)
    assert nodes.places_m == pytest.approx((0.0, 0.05, 0.1, 0.25, 0.3))
    solid, hollow = section(STEPPED.segments[0]), section(STEPPED.segments[1])
    assert nodes.sections == (solid, solid, hollow, hollow)
    finer = shaft_nodes(STEPPED.model_copy(update={"longest_element_m": 0.02}))
    assert max(b - a for a, b in pairwise(finer.places_m)) <= 0.02 + 1e-12
    assert set(np.round(nodes.places_m, 9)) <= set(np.round(finer.places_m, 9))
    assert shaft_length_m(STEPPED) == pytest.approx(0.3)


def test_torsion_in_series():
    modulus = 2.06e11 / 2.6
    first = modulus * math.pi * 0.03**4 / 32 / 0.05
    second = modulus * math.pi * (0.05**4 - 0.02**4) / 32 / 0.15
    nodes = shaft_nodes(STEPPED)
    found = torsional_stiffness_nm_per_rad(nodes, 0.25, 0.05)
    assert found == pytest.approx(1 / (1 / first + 1 / second))


def matrix(element):
    return sum(k * np.outer(w, w) for w, k in element.springs)


@given(
    length=st.floats(0.01, 2.0),
    diameter=st.floats(0.005, 0.5),
    load=st.floats(-1e4, 1e4),
    moment=st.floats(-1e3, 1e3),
)
def test_a_cantilever_under_an_end_load_and_moment(length, diameter, load, moment):
    """w = P L^3/(3 E I) + P L/(kappa G A) + M L^2/(2 E I), slope = P L^2/(2 E I) + M L/(E I): exact in one element."""
    s = section(ShaftSegment(length_m=length, diameter_m=diameter))
    bent = matrix(beam_element(s, length))[2:, 2:]
    found = np.linalg.solve(bent, [load, moment])
    deflection = load * length**3 / (3 * s.bending_nm2) + load * length / s.shear_n
    deflection += moment * length**2 / (2 * s.bending_nm2)
    slope = load * length**2 / (2 * s.bending_nm2) + moment * length / s.bending_nm2
    scale = abs(load) * length**3 / s.bending_nm2 + abs(moment) * length**2 / s.bending_nm2 + 1e-30
    assert found[0] == pytest.approx(deflection, abs=1e-7 * scale + 1e-6 * abs(deflection))
    assert found[1] * length == pytest.approx(slope * length, abs=1e-7 * scale + 1e-6 * abs(slope * length))


@given(length=st.floats(0.01, 2.0), diameter=st.floats(0.005, 0.5))
def test_the_element_is_the_published_matrix(length, diameter):
    """E I / (L^3 (1 + Phi)) [12, 6L, -12, 6L; ., (4 + Phi) L^2, -6L, (2 - Phi) L^2; ...], Friedman & Kosmatka 1993."""
    s = section(ShaftSegment(length_m=length, diameter_m=diameter))
    phi = 12 * s.bending_nm2 / (s.shear_n * length**2)
    le = length
    table = np.array(
        [
            [12, 6 * le, -12, 6 * le],
            [6 * le, (4 + phi) * le**2, -6 * le, (2 - phi) * le**2],
            [-12, -6 * le, 12, -6 * le],
            [6 * le, (2 - phi) * le**2, -6 * le, (4 + phi) * le**2],
        ]
    ) * (s.bending_nm2 / (le**3 * (1 + phi)))
    assert matrix(beam_element(s, le)) == pytest.approx(table, rel=1e-9, abs=1e-9 * np.abs(table).max())


def test_elements_keep_mass_and_inertia():
    nodes = shaft_nodes(STEPPED)
    elements = [beam_element(s, b - a) for (a, b), s in zip(pairwise(nodes.places_m), nodes.sections, strict=True)]
    solid, hollow = 0.1 * 7850 * math.pi / 4 * 0.03**2, 0.2 * 7850 * math.pi / 4 * (0.05**2 - 0.02**2)
    assert sum(2 * e.end_mass_kg for e in elements) == pytest.approx(solid + hollow)
    rotary = solid * 0.03**2 / 16 + hollow * (0.05**2 + 0.02**2) / 16
    assert sum(2 * e.end_rotary_kg_m2 for e in elements) == pytest.approx(rotary)
