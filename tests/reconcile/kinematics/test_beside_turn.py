"""Impacts once a turn make no bearing's lines of their skirts, hide none, and are told beside a bearing's."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.beside_turn import Turned
from reconcile.kinematics.families import Family
from reconcile.report.action import to_do
from signals.series import FloatArray
from tests.strategies.impulses import RATE_HZ, recorded

SPEED_HZ, SECONDS = 24.5, 6.0
DRAWING = {
    "shafts": [{"name": "input", "speed_hz": SPEED_HZ}, {"name": "output"}],
    "bearings": [
        {"name": "drive_end", "shaft": "input", "catalogue": "6205"},
        {"name": "fan_end", "shaft": "input", "balls": 8, "ball_diameter_m": 8.5e-3, "pitch_diameter_m": 36e-3},
    ],
    "gears": [{"name": "pinion", "shaft": "input", "teeth": 21}, {"name": "wheel", "shaft": "output", "teeth": 64}],
    "meshes": [{"name": "mesh1", "gears": ["pinion", "wheel"]}],
}
BPFO, BPFI = 3.5848, 5.4152
NEAR, FAR = (1.0, 0.35, 0.12), (0.5, 0.4, 1.0)
"""How loud the blows are at the three sensors: of a race at the first, of a tooth at the last."""


@dataclass(frozen=True, kw_only=True)
class Hit:
    """Blows at an order of the input, how far they slip, how much once a turn modulates them, and their loudness."""

    order: float
    near: tuple[float, ...]
    slip: float = 0.01
    load: float = 0.0


PIT, INNER = Hit(order=BPFO * 0.995, near=NEAR), Hit(order=BPFI * 1.003, near=NEAR, load=1.0)
TOOTH = Hit(order=1.0, near=FAR, slip=2e-4)


def _turned(time: FloatArray, rng: np.random.Generator) -> FloatArray:
    return np.asarray(np.cumsum(SPEED_HZ * (1 + 1e-3 * np.sin(1.88 * time + rng.uniform(0, 6)))) / RATE_HZ)


def made(seed: int, *hits: Hit) -> FloatArray:
    """Three channels of a gearbox whose speed wanders by a thousandth; what strikes follows the other lines not to the
    degree, as where the angle is not known any better."""
    rng = np.random.default_rng(seed)
    time = np.arange(round(SECONDS * RATE_HZ)) / RATE_HZ
    turns = _turned(time, rng)
    fall = np.arange(round(0.02 * RATE_HZ)) / RATE_HZ
    mesh = np.stack([np.cos(21 * k * turns * 2 * np.pi + k) / k for k in (1, 2, 3)]).sum(axis=0)
    mesh = mesh * (1 + 0.12 * np.cos(2 * np.pi * turns) + 0.08 * np.cos(2 * np.pi * turns * 21 / 64))
    low = np.stack([0.4 / k**1.5 * np.cos(2 * np.pi * k * turns + k) for k in (1, 2, 3, 4)]).sum(axis=0)
    rows = [mesh + low + 0.6 * rng.standard_normal(time.size) for _ in NEAR]
    for hit in hits:
        turns = _turned(time, rng)
        steps = (1 + hit.slip * rng.standard_normal(round(turns[-1] * hit.order) + 9)) / hit.order
        at = rng.uniform(0, 1) / hit.order + np.cumsum(steps)
        at = at[at < turns[-1]]
        blows = np.zeros(time.size)
        strength = np.maximum(0.1, 1 + hit.load * np.cos(2 * np.pi * at)) if hit.load else np.ones(at.size)
        np.add.at(blows, (np.interp(at, turns, time) * RATE_HZ).astype(int), strength)
        for i, hz in enumerate((3100.0, 2700.0, 3600.0)):
            ring = np.exp(-700 * fall) * np.sin(2 * np.pi * hz * fall)
            rows[i] = rows[i] + 6.0 * hit.near[i] * np.convolve(blows, ring)[: time.size]
    return np.stack(rows)


def answered(seed: int, *hits: Hit):  # type: ignore[no-untyped-def]
    spec = read_kinematic_spec({"kinematics": DRAWING})
    test, base = (recorded(rows, SPEED_HZ, "input") for rows in (made(seed, *hits), made(1)))
    return reconcile_kinematics(spec, [test], [base], seed=0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [61, 63])
def test_of_a_pit_and_a_tooth_only_the_pits_bearing_is_named(seed: int) -> None:
    """The inner race of the sound bearing is drawn 1.1 % below five times the turn, its outer race below three times:
    either was named, or said instead of the pit."""
    report = answered(seed, PIT, TOOTH)
    assert report.verdict == "explained", report.sentence
    assert [(c.term, c.site) for c in report.causes if c.named] == [("outer_spall", "drive_end")]
    assert "fan_end" not in f"{report.sentence} {report.undecidable}"
    assert "Beside it impacts once a turn of input rose" in report.sentence
    assert any(t.startswith("what strikes once a turn of input") and "pinion" in t for t in report.undecidable)
    assert "Look at what strikes once a turn of input too: the teeth of pinion" in to_do(report)


@pytest.mark.slow
@pytest.mark.parametrize(("hit", "term"), [(PIT, "outer_spall"), (INNER, "inner_spall")])
def test_a_race_alone_brings_no_impacts_beside_it(hit: Hit, term: str) -> None:
    """An inner race is struck harder once a turn."""
    report = answered(5, hit)
    assert [(c.term, c.site) for c in report.causes if c.named] == [(term, "drive_end")]
    assert "once a turn" not in f"{report.sentence} {report.undecidable} {to_do(report)}"


@dataclass(frozen=True, kw_only=True)
class Found:
    """A family of a search."""

    family: Family
    best: SimpleNamespace
    z: float
    chance: float = 1e-6
    present: bool = True
    risen: bool = True
    of_turn: bool = False
    strongest: int = 0


def found(kind: str, order: float, z: float, chance: float = 1e-6) -> Found:
    family = Family(kind=kind, site="b", order=order, spacing=0.0, sidebands=0, slip=0.0)  # type: ignore[arg-type]
    best = SimpleNamespace(order=order, channel="a0")
    return Found(family=family, best=best, z=z, chance=chance, present=chance < 0.01)


TEST = SimpleNamespace(channel=lambda _: SimpleNamespace(order_step=0.0124))


@pytest.mark.parametrize(
    ("order", "left", "turn_z", "told"),
    [(5.019, 0.2, 41.0, True), (5.019, 1e-6, 41.0, False), (5.019, 0.2, 3.0, False), (4.947, 0.2, 41.0, False)],
)
def test_what_stands_next_to_a_firmer_turn_must_stand_without_it(
    order: float, left: float, turn_z: float, told: bool
) -> None:
    turn, one = found("turn", 0.9999, turn_z), found("inner", order, 7.0)
    turned = Turned([turn, one], [TEST], lambda _: (found("inner", order, 9.0, chance=left),))  # type: ignore[arg-type, list-item, return-value]
    assert turned.leaves(one) is told  # type: ignore[arg-type]
    assert turned.told(one).of_turn is told  # type: ignore[arg-type]


@pytest.mark.parametrize(("order", "again", "freed"), [(3.564, 3.565, True), (3.564, 3.6, False), (3.01, 3.01, False)])
def test_a_line_that_only_the_turn_hides_is_present(order: float, again: float, freed: bool) -> None:
    """Away from the turn's multiples, and the same line without them."""
    turn, one = found("turn", 1.0, 41.0), found("outer", order, 17.8, chance=0.03)
    without = replace(found("outer", order, 17.8), best=SimpleNamespace(order=again, channel="a0"))
    turned = Turned([turn, one], [TEST], lambda _: (without,))  # type: ignore[arg-type, list-item, return-value]
    assert turned.told(one).present is freed  # type: ignore[arg-type]
    calm = Turned([replace(turn, risen=False), one], [TEST], lambda _: (without,))  # type: ignore[arg-type, list-item, return-value]
    assert not calm.told(one).present  # type: ignore[arg-type]
