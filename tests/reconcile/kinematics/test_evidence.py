"""Chances mean what they say; rivals and helpers against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.chances import fisher, holm
from reconcile.kinematics.combs import Stretch, Train, comb_power, fitted, predicted
from reconcile.kinematics.envelopes import Envelopes, envelopes
from reconcile.kinematics.evidence import family_evidence, logs
from reconcile.kinematics.families import ties
from reconcile.kinematics.gears import gear_evidence
from reconcile.kinematics.judge import HEARD_Z
from reconcile.kinematics.observe import observe
from tests.strategies.brief import RATE_HZ, SPEED_HZ, N, recorded, sound, train

SPEC = read_kinematic_spec(
    {"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [{"name": "b", "shaft": "shaft", "catalogue": "6205"}]}}
)
TIES = ties(SPEC)
SHORT = N // 3


def seen(samples):  # type: ignore[no-untyped-def]
    recording = recorded(samples)
    angle = 2 * np.pi * SPEED_HZ * np.arange(samples.size) / RATE_HZ
    return [envelopes(recording, "a0", angle, highest_base=6.0, highest_order=26.0)]


@pytest.mark.slow
def test_chances_of_noise_are_uniform() -> None:
    rng = np.random.default_rng(0)
    chances = []
    for _ in range(25):
        channels = seen(rng.standard_normal(SHORT))
        chances += [family_evidence(channels, TIES, f, 0.0, rng).chance for f in TIES.families if f.kind != "turn"]
    found = np.asarray(chances)
    assert found.size == 100
    # two standard deviations of a binomial share around what uniform chances give
    assert np.mean(found < 0.05) <= 0.05 + 2 * np.sqrt(0.05 * 0.95 / 100)
    assert np.mean(found < 0.5) == pytest.approx(0.5, abs=2.5 * np.sqrt(0.25 / 100))


@pytest.mark.slow
def test_evidence_grows_with_the_defect_and_finds_the_slip() -> None:
    noise = np.random.default_rng(1).standard_normal(N)
    z = []
    for height in (0.5, 1.0, 2.0):
        hits = train(np.random.default_rng(2), 3.5848 * 0.985, height)
        found = family_evidence(seen(0.3 * noise + hits), TIES, TIES.families[0], 0.0, np.random.default_rng(3))
        z.append(found.z)
    assert z[0] < z[1] < z[2]
    assert found.slip == pytest.approx(-0.015, abs=0.002)
    assert found.band_hz[0] < 4200 < found.band_hz[1] or found.band_hz[1] > 3000


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2, 7))
def test_sidebands_of_a_race_do_not_hide_it(seed: int) -> None:
    """An inner race in the load zone has many sidebands, which the controls meet."""
    inner = next(f for f in TIES.families if f.kind == "inner")
    noise = np.random.default_rng(1).standard_normal(N)
    hits = train(np.random.default_rng(seed), inner.order, 4.0, zone=True)
    heard = seen(0.3 * noise + hits)
    found = family_evidence(heard, TIES, inner, 0.0, np.random.default_rng(3), certain_z=HEARD_Z)
    assert found.z > 10.0 and found.slip == pytest.approx(0.0, abs=0.003)


GEARED = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}, {"name": "slow"}],
            "bearings": [{"name": "b", "shaft": "shaft", "balls": 7, "diameter_ratio": 0.2647}],
            "gears": [{"name": "p", "shaft": "shaft", "teeth": 23}, {"name": "g", "shaft": "slow", "teeth": 81}],
            "meshes": [{"name": "m", "gears": ["p", "g"]}],
        }
    }
)
"""Nine turns of the slow shaft are the outer race of seven balls to 0.7 %."""


def heights(lines: dict[float, float], turns: float):  # type: ignore[no-untyped-def]
    """Envelopes of a recording of so many turns that are noise but for lines (order: power over the floor)."""
    step = 1.0 / turns
    excess = np.random.default_rng(0).exponential(size=(1, round(26.0 / step)))
    for order, power in lines.items():
        excess[0, round(order / step)] = power
    return Envelopes(
        channel="a0", bands_hz=np.array([[0.0, 1.0]]), order_step=step, excess=excess, depth=excess,
        angle_rad=excess[0], kurtosis=np.zeros(1), turns=turns,
    )  # fmt: skip


def test_lines_at_multiples_of_a_slow_shaft_are_not_its_where_these_are_usually_empty() -> None:
    tie = ties(GEARED)
    slow = tie.shafts["slow"]
    race = {k * 9 * slow: 1e3 for k in range(1, 5)}
    first = {slow: 1e3, 3 * slow: 1e3, 23.0 + slow: 1e3, 2.0: 1e3}
    short = heights({**race, **first}, turns=27.0)
    values = logs(short, tie, shaft_lines=False)[0]
    assert all(values[short.place(np.array([order]))[0]] > 5.0 for order in race)
    assert all(values[short.place(np.array([order]))[0]] == 0.0 for order in first)
    for last in (10, 14, 18, 24, 91):
        broken = heights({k * slow: 1e3 for k in range(1, last + 1)}, turns=27.0)
        values = logs(broken, tie, shaft_lines=False)[0]
        lines = broken.place(slow * np.arange(1, last + 1))
        assert values[lines].max() == 0.0, "a tooth's, or a rub's that dies out"
    slowest = replace(tie, shafts={"shaft": 1.0, "slow": short.order_step / 10})
    flat = replace(short, excess=np.full_like(short.excess, 1e3))
    assert logs(flat, slowest, shaft_lines=False).max() == 0.0, "everything lies on a multiple, and all are high"
    long = heights({**race, **first}, turns=270.0)
    values = logs(long, tie, shaft_lines=False)[0]
    assert all(values[long.place(np.array([order]))[0]] == 0.0 for order in race), "turns enough to tell them apart"
    few = replace(tie, shafts={"shaft": 1.0, "fast": 5.0})
    assert np.isfinite(logs(heights(race, turns=3.0), few, shaft_lines=False)).all(), "too few multiples to tell"


def test_fisher_and_holm() -> None:
    assert fisher([0.03]) == pytest.approx(0.03)
    # chi-square with 4 degrees: exp(-s/2) (1 + s/2) with s/2 = -ln(p1 p2)
    half = -np.log(0.1 * 0.2)
    assert fisher([0.1, 0.2]) == pytest.approx(np.exp(-half) * (1 + half))
    assert holm([0.01, 0.04, 0.03]) == pytest.approx([0.03, 0.06, 0.06])


def test_a_comb_is_fitted_back() -> None:
    orders = np.arange(0.3, 25.0, 0.05)
    on = Stretch(log_power=np.zeros(orders.size), orders=orders)
    outer = Train(family=TIES.families[0], order=3.58, pair=0.15)
    truth = np.array([-2.0, 1.5, -1.0, -2.0, 0.001, 0.6, -7.0])
    before = -9.0 + 2.0 * np.cos(2.1 * orders)
    rng = np.random.default_rng(5)
    power = np.exp(before) + comb_power(outer, on, truth)
    fit = Stretch(log_power=np.log(power * rng.gamma(20, 1 / 20, orders.size)), orders=orders)
    p = fitted(outer, fit, before)
    assert p[0] == pytest.approx(-2.0, abs=0.4) and p[5] == pytest.approx(0.6, abs=0.1)
    assert p[6] == pytest.approx(-7.0, abs=0.5)
    assert np.sqrt(np.mean((predicted(outer, fit, before, p) - np.log(power)) ** 2)) < 0.15


GEARBOX = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}, {"name": "out"}],
            "gears": [{"name": "pinion", "shaft": "shaft", "teeth": 23}, {"name": "gear", "shaft": "out", "teeth": 61}],
            "meshes": [{"name": "mesh1", "gears": ["pinion", "gear"]}],
        }
    }
)


def geared(seed: int, *, fault: float = 0.0, load: float = 1.0):  # type: ignore[no-untyped-def]
    """Mesh with weak runout of both shafts; `fault` deepens one tooth of the gear (a dip 3 % of its turn wide)."""
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * SPEED_HZ * np.arange(N) / RATE_HZ
    out = angle * 23 / 61
    dip = np.exp(-0.5 * ((np.mod(out, 2 * np.pi) - 2.0) / 0.1) ** 2)
    # runout of several orders: a machine has some sidebands to begin with
    wobble = 1 + sum(0.01 * np.cos(m * angle + m) + 0.01 * np.cos(m * out - m) for m in range(1, 9)) - fault * dip
    mesh = sum(a * np.cos(k * 23 * angle + k) for k, a in ((1, 1.0), (2, 0.5), (3, 0.3)))
    return load * wobble * mesh + 0.05 * rng.standard_normal(N)


@pytest.mark.slow
def test_a_tooth_fault_is_told_from_load() -> None:
    tie = ties(GEARBOX, "shaft")
    base, same, loaded, broken = (
        observe(replace(recorded(x)), tie, "r", stated_hz=None, seed=0)
        for x in (geared(1), geared(2), geared(3, load=2.5), geared(4, fault=0.8))
    )
    assert not any(g.grown for g in gear_evidence([same], [base], tie))
    assert not any(g.grown for g in gear_evidence([loaded], [base], tie))
    first = gear_evidence([broken], [base], tie)[0]
    assert first.grown and first.gear == "gear"
    assert first.window is not None and first.window.shaft == "out"
    assert first.window.centre_deg == pytest.approx(np.degrees(2.0), abs=8.0)


@pytest.mark.slow
@pytest.mark.parametrize("scale", [1e-29, 1e28])
def test_the_largest_and_smallest_sizes_that_are_taken_can_be_judged(scale: float) -> None:
    rng = np.random.default_rng(2)
    rows = sound(1), sound(2) + train(rng, 3.5848, 1.0)
    report = reconcile_kinematics(SPEC, [recorded(scale * rows[1])], [recorded(scale * rows[0])], seed=3)
    assert (report.verdict, report.causes[0].term) == ("explained", "outer_spall")
