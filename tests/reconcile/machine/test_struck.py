"""Which second part is struck: one that has lines of its own, not those of the first one's cage."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics.candidate import Candidate
from reconcile.kinematics.evidence import Evidence
from reconcile.kinematics.families import HARMONICS, Family, ties
from reconcile.kinematics.spec import of_machine
from reconcile.machine import struck as parts
from reconcile.machine.direct import Direct, direct_evidence
from reconcile.observe.observation import observe
from reconcile.observe.watch import bases_at, watch_list
from signals.series import FloatArray
from sim.presets import preset
from tests.reconcile.machine.test_direct import CHANNELS, TIME, recording, sound, struck

MACHINE = preset("paper-lightly-damped")
SPEED_HZ = 30.0
HZ = bases_at(MACHINE, SPEED_HZ)
TIE = ties(of_machine(MACHINE))
SLIP = 0.006


def family(key: str) -> Family:
    return next(f for f in TIE.families if f.key == key)


@cache
def pit(of: str) -> FloatArray:
    """Struck as a cage strikes it that turns faster by `SLIP`: outer races as much faster, inner ones slower."""
    if of == "f_o1":
        return struck(HZ[of], slip=SLIP)
    cage = family("bearing1.cage").order
    return struck(HZ[of], slip=-SLIP * cage / (1 - cage), loads_hz=SPEED_HZ)


def by_cage(depth: float) -> FloatArray:
    """Blows of balls that are not alike: they repeat with the cage, here every half and every quarter of its turn."""
    turn = 2 * np.pi * family("bearing1.cage").order * (1 + SLIP) * SPEED_HZ * TIME
    return 1 + depth * (np.cos(2 * turn) + np.cos(4 * turn))


def told(signal: FloatArray) -> Direct:
    data = observe(MACHINE, watch_list(MACHINE), [recording(sound(1) + signal)], [recording(sound(2))])
    return direct_evidence(MACHINE, data, CHANNELS, seed=0)


@pytest.mark.parametrize("of", ["f_o1", "f_i1"])
def test_one_pit_whose_blows_repeat_with_the_cage_is_one_part(of: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Twice the cage of the fast shaft is 0.6 % off the outer race of the slow one's bearings (x001 of the proof)."""
    assert abs(2 * family("bearing1.cage").order / family("bearing3.outer").order - 1) < 0.01, "the case that is meant"
    signal = 2 * pit(of) * by_cage(0.5)
    assert told(signal).struck == ()
    monkeypatch.setattr(parts, "_at_cage", lambda *_: False)
    assert any("outer_spall@bearing3" in part for part in told(signal).struck), "it would be told twice"


def test_a_second_pit_elsewhere_is_told() -> None:
    both = told(1.2 * pit("f_o1") + struck(HZ["f_i3"], slip=0.003, loads_hz=SPEED_HZ * 23 / 81)[::-1])
    assert len(both.struck) == 2 and any("inner_spall@bearing3" in part for part in both.struck)


def test_a_line_of_the_cage_is_met_within_slip_by_bearings_alone() -> None:
    cage = family("bearing1.cage")
    at = replace(family("bearing3.outer"), order=2 * cage.order)
    for k in range(1, HARMONICS["cage"] + 1):
        assert parts._at_cage(replace(at, order=k * cage.order * (1 + 0.9 * cage.slip)), cage)
        assert not parts._at_cage(replace(at, order=k * cage.order * (1 + 1.1 * cage.slip)), cage)
    assert not parts._at_cage(replace(at, order=5 * cage.order), cage)
    assert not parts._at_cage(replace(at, kind="turn", slip=0.0), cage), "a shaft that happens to turn so"


@pytest.mark.parametrize(("kind", "balls_before"), [("outer", True), ("inner", False)])
def test_the_cage_turns_as_the_struck_race_tells(kind: str, balls_before: bool) -> None:
    """Z times the cage's speed before the race: outer Z f, inner Z (1 - f)."""
    own, cage = family(f"bearing1.{kind}"), family("bearing1.cage")
    balls, turns = TIE.races["bearing1"].balls, cage.order * 0.99
    order = balls * (turns if balls_before else 1.0 - turns)
    seen = Evidence(
        family=own, z=9.0, chance=0.0, slip=0.0, order=order, channel="a", band_hz=(0.0, 1.0), depth=1.0, channel_z={}
    )
    found = parts._cage_of(Candidate(family=own, evidence=(seen,), contrasts=(), chance=0.0), TIE)
    assert found is not None and found.evidence[0].order == pytest.approx(turns)
    turn = SimpleNamespace(family=family("input.turn"))
    assert parts._cage_of(turn, TIE) is None  # type: ignore[arg-type]
