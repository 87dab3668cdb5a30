import numpy as np
import pytest

from learn import whole
from learn.assess import ANYWHERE, WHOLE, assess
from learn.bank import bank
from learn.geometries import NAMES, log_ratios, rows, usual, vector
from learn.model import Head, Model, Network
from learn.unknown import NAMES as SEEN
from sideband_datasets.recipe.bearings import CLASSES

RATE, SPEED = 20_000.0, 25.0


def spectra_of(x):
    return bank([x], RATE, SPEED)


def head(names, weights):
    """Scores that are sums of named features, per class."""
    table = np.zeros((len(names), len(CLASSES)))
    for kind, own in weights.items():
        for name, weight in own.items():
            table[names.index(name), CLASSES.index(kind)] = weight
    return Head(
        features=tuple(names),
        classes=CLASSES,
        mean=np.zeros(len(names)),
        scale=np.ones(len(names)),
        networks=(Network(weights=(table,), offsets=(np.zeros(len(CLASSES)),)),),
        temperature=1.0,
    )


@pytest.fixture
def known():
    """A fault is as likely as its family stands out."""
    return head(whole.NAMES, {f: {f"long_lift_{f}": 1.0} for f in whole.RACES})


def test_weights_are_a_prior_and_the_orders_are_those_of_bearings():
    assert sum(g.weight for g in usual()) == pytest.approx(1.0)
    for one in usual():
        balls = one.orders.outer + one.orders.inner
        assert balls == pytest.approx(round(balls))
        assert one.orders.cage == pytest.approx(one.orders.outer / balls)


@pytest.mark.parametrize("family", ["outer", "inner"])
def test_a_fault_is_found_whatever_the_bearing(impacts, bearing, known, family):
    x = impacts(getattr(bearing, family), weight=0.8 if family == "inner" else 0.0)
    found = log_ratios(rows(spectra_of(x)), known)
    assert whole.RACES[int(np.argmax(found))] == family
    assert np.max(found) > 1.0


def test_in_noise_no_fault_is_likelier_than_none(known):
    noise = np.random.default_rng(3).standard_normal(32_000)
    assert np.all(log_ratios(rows(spectra_of(noise)), known) < 1.5)


def test_features_of_the_true_geometry_are_close_to_those_of_a_known_one(impacts, bearing):
    spectra = spectra_of(impacts(bearing.outer))
    exact = whole.vector(spectra, bearing)[0]
    nearest = int(
        np.argmin([abs(g.orders.outer / bearing.outer - 1) + abs(g.orders.cage / bearing.cage - 1) for g in usual()])
    )
    tried = rows(spectra)[nearest]
    for name in ("long_lift_outer", "long_depth_outer", "long_impulsive"):
        k = whole.NAMES.index(name)
        assert tried[k] == pytest.approx(exact[k], abs=0.15 * abs(exact[k]) + 0.05)


def test_the_sum_over_geometries_counts_each_as_common_as_it_is(known):
    table = np.zeros((len(usual()), len(whole.NAMES)))
    np.testing.assert_allclose(log_ratios(table, known), 0.0, atol=1e-9)
    at = whole.NAMES.index("long_lift_inner")
    table[3, at] = 5.0
    expected = np.log(1 + usual()[3].weight * (np.exp(5.0) - 1))
    assert log_ratios(table, known)[1] == pytest.approx(expected)


def test_a_comb_of_the_mains_is_no_fault(impacts, known):
    turning = rows(spectra_of(impacts(100.0 / SPEED * 1.03)))
    electric = rows(spectra_of(impacts(120.0 / SPEED)))
    assert np.max(log_ratios(electric, known)) < np.max(log_ratios(turning, known)) - 2.0


def test_long_recordings_are_answered_over_all_geometries(impacts, bearing, known):
    names = [f"likelier_{f}" for f in whole.RACES]
    model = Model(
        heads={
            "unknown": head(SEEN, {}),
            WHOLE: known,
            ANYWHERE: head(NAMES, {f: {name: 1.0} for f, name in zip(whole.RACES, names, strict=True)}),
        },
        made_by={},
    )
    long = assess([impacts(bearing.outer)], RATE, SPEED, model, None)
    short = assess([impacts(bearing.outer, turns=15.0)], RATE, SPEED, model, None)
    assert long.label == "outer"
    assert short.probabilities["outer"] == pytest.approx(0.25)


def test_the_vector_holds_both(impacts, bearing, known):
    assert vector(spectra_of(impacts(bearing.outer)), known).shape == (len(NAMES),)
