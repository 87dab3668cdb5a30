import numpy as np
import pytest

from learn import geometries, unknown, whole
from learn.assess import assess
from learn.bank import bank
from learn.combs import lift, logs
from learn.looked import stretches
from learn.model import Model
from learn.sim2real.table import Example, joined, train
from learn.whole import NAMES, cage, cage_grid, foreign, taken_out, vector
from sideband_datasets.recipe.bearings import CLASSES

RATE, SPEED, TURNS = 20_000.0, 25.0, 80.0


def noise(seed, turns=TURNS):
    return np.random.default_rng(seed).standard_normal(int(turns / SPEED * RATE))


def passing_ball(bearing, seed, depth=0.8):
    """Noise that is louder once a turn of the cage, for a tenth of it: no line at the ball's own order."""
    x = noise(seed)
    phase = (bearing.cage * SPEED * np.arange(x.size) / RATE) % 1.0
    return x * np.sqrt(1 + depth * 3 * (phase < 0.15))


def value(x, bearing, name):
    return float(vector(bank([x], RATE, SPEED), bearing)[0][NAMES.index(name)])


@pytest.mark.slow
def test_a_ball_that_passes_the_load_is_seen_by_the_cages_lines_alone(bearing):
    ball, sound = passing_ball(bearing, 1), noise(1)
    assert value(ball, bearing, "long_cage_all") > value(sound, bearing, "long_cage_all") + 1.0
    assert value(ball, bearing, "long_chance_ball") < 2.5


def test_the_cages_sidebands_of_the_shafts_lines_count_too(bearing):
    turn = SPEED * np.arange(noise(2).size) / RATE
    level = 1 + 0.35 * sum(np.cos(2 * np.pi * (k + s * bearing.cage) * turn) for k in (5, 9, 12) for s in (-1, 1)) / 2
    assert value(noise(2) * np.sqrt(np.maximum(level, 0)), bearing, "long_cage_all") > 1.5


def test_lines_of_a_race_are_taken_out_with_their_sidebands(bearing):
    spectra = bank([noise(3)], RATE, SPEED)
    values = np.ones_like(logs(spectra))
    taken_out(values, spectra.step, bearing.inner)
    at = np.arange(values.shape[1]) * spectra.step
    for centre in (bearing.inner, 2 * bearing.inner + 1, 3 * bearing.inner - 2):
        assert np.all(values[:, np.abs(at - centre) < 2 * spectra.step] == 0.0)
    assert np.all(values[:, np.abs(at - 0.5 * bearing.inner) < 2 * spectra.step] == 1.0)


def test_the_cage_is_compared_with_orders_that_share_no_line_with_it(bearing):
    base = cage_grid(0.0125)
    away = foreign(base, bearing.cage)
    assert np.sum(away) > 0.3 * base.size
    for relative in (bearing.cage, (1 - bearing.cage) / 2, 1 - 2 * bearing.cage):
        assert not np.any(away[np.abs(base / relative - 1) < 0.03])


@pytest.mark.slow
def test_more_channels_of_noise_do_not_look_more_faulty(bearing):
    """The best of many bands is larger, but so it is at foreign orders."""
    rng = np.random.default_rng(7)

    def middle(count):
        found = []
        for _ in range(6):
            rows = [rng.standard_normal(int(30 / SPEED * RATE)) for _ in range(count)]
            found.append(vector(bank(rows, RATE, SPEED), bearing)[0][NAMES.index("long_lift_outer")])
        return float(np.median(found))

    assert middle(6) < middle(1) + 1.0


def test_lift_is_over_the_middle_of_what_is_found_elsewhere():
    assert lift(np.array([1.0, 2.0, 9.0]), 5.0) == 3.0
    assert lift(np.zeros(0), 5.0) == 0.0


def test_cage_of_an_empty_spectrum_is_nothing(bearing):
    base = cage_grid(0.0125)
    near = np.abs(base / bearing.cage - 1) < 0.03
    assert cage(np.zeros((3, 3200)), 0.0125, near, foreign(base, bearing.cage), base) == (0.0, 0.0)


@pytest.mark.slow
def test_features_know_neither_unit_nor_offset(bearing):
    a, b = (vector(bank([x], RATE, SPEED), bearing)[0] for x in (noise(5), 3e-3 * noise(5) + 2.0))
    np.testing.assert_allclose(a, b, atol=1e-4)
    assert a.shape == (len(NAMES),)


def test_long_recordings_are_read_in_parts():
    assert len(stretches([noise(5, turns=200.0)], RATE, SPEED, whole.TURNS)) == 2


@pytest.fixture(scope="module")
def model():
    """Heads that answer by their offsets alone: pieces say `outer`, whole recordings `ball`."""
    rng = np.random.default_rng(0)
    examples = [
        Example(
            label=CLASSES[k % 4],
            machine=k,
            known=[rng.standard_normal(17)],
            unknown=[rng.standard_normal(16)],
            long=rng.standard_normal((1, len(NAMES))),
            anywhere=rng.standard_normal((1, len(unknown.NAMES))),
            tried=rng.standard_normal((1, len(geometries.usual()), len(NAMES))),
        )
        for k in range(24)
    ]
    heads = dict(train(joined(examples), seed=0, made_by={}).heads)
    for name, label in (("known", "outer"), ("whole", "ball"), ("unknown", "inner"), ("anywhere", "healthy")):
        for network in heads[name].networks:
            network.offsets[-1][CLASSES.index(label)] += 1e4
    return Model(heads=heads, made_by={})


@pytest.mark.slow
def test_the_whole_decides_for_long_recordings_and_pieces_for_short_ones(model, bearing):
    assert len(model.heads["whole"].networks[0].weights) == 1
    assert assess([noise(6)], RATE, SPEED, model, bearing).label == "ball"
    assert assess([noise(6, turns=12.0)], RATE, SPEED, model, bearing).label == "outer"
    assert assess([noise(6)], RATE, SPEED, model, None).label == "healthy"
    assert assess([noise(6, turns=12.0)], RATE, SPEED, model, None).label == "inner"


def test_a_model_without_the_head_answers_by_its_pieces(model, bearing):
    older = Model(heads={k: v for k, v in model.heads.items() if k != "whole"}, made_by={})
    assert assess([noise(6)], RATE, SPEED, older, bearing).label == "outer"
    assert assess([noise(6)], RATE, SPEED, older, None).label == "inner"


@pytest.mark.slow
def test_a_short_recording_of_doubtful_speed_is_answered_at_every_likely_one(model, bearing):
    short = [noise(6, turns=12.0)]
    alone = [assess(short, RATE, f, model, bearing, 0.005).probabilities for f in (24.5, 25.5)]
    both = assess(short, RATE, SPEED, model, bearing, 0.01, (24.5, 25.5)).probabilities
    for label, p in both.items():
        assert p == pytest.approx(np.mean([one[label] for one in alone]))
    long = [noise(6)]
    assert assess(long, RATE, SPEED, model, bearing, 0.01, (24.5, 25.5)) == assess(
        long, RATE, SPEED, model, bearing, 0.01
    )
