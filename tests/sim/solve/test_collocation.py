"""The collocation tables against Hairer & Wanner, Solving ODEs II, 2nd ed., sect. IV.5."""

from __future__ import annotations

import numpy as np
import pytest

from sim.solve.collocation import (
    collocation,
    derivative_weights,
    extrapolation,
    lagrange_coefficients,
    node_extrapolation,
    radau_nodes,
)

ROOT = np.sqrt(6.0)
# Table 5.6 of the book: Radau IIA of order 5
NODES = np.array([(4 - ROOT) / 10, (4 + ROOT) / 10, 1.0])
WEIGHTS = np.array([(16 - ROOT) / 36, (16 + ROOT) / 36, 1 / 9])
MATRIX = np.array(
    [
        [(88 - 7 * ROOT) / 360, (296 - 169 * ROOT) / 1800, (-2 + 3 * ROOT) / 225],
        [(296 + 169 * ROOT) / 1800, (88 + 7 * ROOT) / 360, (-2 - 3 * ROOT) / 225],
        [(16 - ROOT) / 36, (16 + ROOT) / 36, 1 / 9],
    ]
)


def test_nodes_and_weights_of_order_five():
    rule = collocation(3)
    assert rule.c == pytest.approx(NODES, rel=1e-15)
    assert rule.b == pytest.approx(WEIGHTS, rel=1e-13)


def test_integrated_lagrange_polynomials_give_the_printed_matrix():
    rule = collocation(3)
    powers = np.arange(1, 4)
    matrix = (rule.c[:, None] ** powers / powers) @ rule.lagrange.T
    assert matrix == pytest.approx(MATRIX, rel=1e-12)


@pytest.mark.parametrize("stages", [1, 2, 3])
def test_quadrature_is_exact_to_degree_two_s_minus_two(stages):
    rule = collocation(stages)
    for degree in range(2 * stages - 1):
        assert rule.b @ rule.c**degree == pytest.approx(1.0 / (degree + 1), rel=1e-13)
    assert rule.b @ rule.c ** (2 * stages - 1) != pytest.approx(1.0 / (2 * stages), rel=1e-6)


def test_lagrange_polynomials_are_one_at_their_own_node():
    nodes = radau_nodes(3)
    assert np.vander(nodes, increasing=True) @ lagrange_coefficients(nodes).T == pytest.approx(np.eye(3), abs=1e-13)


@pytest.mark.parametrize("ratio", [0.25, 0.5, 1.0, 2.0])
def test_extrapolation_continues_polynomials(ratio):
    known = np.concatenate([[0.0], NODES])
    cubic = np.polynomial.Polynomial([1.0, -2.0, 0.5, 3.0])
    square = np.polynomial.Polynomial([1.0, -2.0, 0.5])
    assert extrapolation(3, ratio) @ cubic(known) == pytest.approx(cubic(1.0 + ratio * NODES), rel=1e-11)
    assert node_extrapolation(3, ratio) @ square(NODES) == pytest.approx(square(1.0 + ratio * NODES), rel=1e-11)


def test_slopes_of_a_cubic():
    cubic = np.polynomial.Polynomial([1.0, -2.0, 0.5, 3.0])
    known = np.concatenate([[0.0], NODES])
    assert derivative_weights(3) @ cubic(known) == pytest.approx(cubic.deriv()(NODES), rel=1e-11)


def test_untabulated_stages_are_refused():
    with pytest.raises(ValueError, match="1 to 3 stages"):
        radau_nodes(4)
