"""Tones near a natural frequency with their multiples are the machine's own; others are left to the measurement."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate.findings import Finding
from reconcile.machine.self_excited import covered, self_excited
from reconcile.machine.strange import explained_by, with_strange
from reconcile.verdict import Report, SensorFault, Where
from sim.core.response import Channel
from sim.presets import preset

MACHINE = preset("rotor")  # natural frequencies of 336 and 371 Hz
CHANNELS = tuple(Channel(name=f"a{k}", quantity="acceleration", unit="m/s^2", location=f"bearing{k}") for k in (1, 2))


def tones(*hz: float, shares: tuple[float, ...] = (0.8, 0.5)) -> tuple[Finding, ...]:
    return tuple(
        Finding(kind="fixed_tones", channel=c.name, recording="test 1", detail="", severity=s, fault=True, tones_hz=hz)
        for c, s in zip(CHANNELS, shares, strict=True)
    )


def test_a_tone_near_a_mode_with_its_multiples_is_told_with_the_mode() -> None:
    found = self_excited(MACHINE, tones(424.2, 848.4, 1272.6), CHANNELS)
    assert found is not None
    assert (found.hz, found.own_hz) == (424.2, pytest.approx(370.7, abs=0.5))
    assert [p.site for p in found.sites(MACHINE)] == ["bearing1", "bearing2"]
    assert sum(p.weight for p in found.sites(MACHINE)) == pytest.approx(1.0)


@pytest.mark.parametrize(
    "findings",
    [
        tones(424.2, 900.0),
        tones(500.0, 1000.0),
        tones(275.0, 550.0),
        tones(212.1, 424.2, 848.4),
        tones(5_000.0, 10_000.0, 15_000.0),
        tones(424.2, 848.4)[:1],
        tones(424.2, 848.4, shares=(0.1, 0.1)),
        (),
        (tones(424.2, 848.4)[0], replace(tones(424.2, 848.4)[1], tones_hz=(700.0, 1400.0))),
    ],
)
def test_what_has_no_multiples_no_mode_or_is_not_everywhere_is_not(findings: tuple[Finding, ...]) -> None:
    assert self_excited(MACHINE, findings, CHANNELS) is None


@pytest.mark.parametrize("name", ["paper-lightly-damped", "bearing-rig"])
def test_with_teeth_or_modes_everywhere_any_tone_is_near_one_and_none_is_told(name: str) -> None:
    machine = preset(name)
    for hz in (225.0, 253.0, 305.0, 371.0):
        assert self_excited(machine, tones(hz, 2 * hz, 3 * hz), CHANNELS) is None
    assert covered([100.0]) == pytest.approx(np.log(1.2 / 0.85) / np.log(2_000.0 / 30.0), abs=0.01)


def test_a_multiple_is_told_within_half_a_per_cent_only() -> None:
    assert self_excited(MACHINE, tones(424.2, 848.4 * 1.004), CHANNELS) is not None
    assert self_excited(MACHINE, tones(424.2, 848.4 * 1.01), CHANNELS) is None


def test_it_is_the_answer_and_no_fault_of_the_measurement() -> None:
    seen = self_excited(MACHINE, tones(424.2, 848.4), CHANNELS)
    fault = SensorFault(kind="fixed_tones", channel="a1")
    report = Report(verdict="measurement_fault", sentence="so.", level="machine", where=Where(), fault=fault)
    found = with_strange(report, seen, MACHINE, {})
    assert (found.verdict, found.fault) == ("unknown_physics", None)
    assert "another machine or a drive" in found.sentence and "another machine or a drive" in found.undecidable[0]
    assert "424.2 Hz and multiples of it at every speed" in found.sentence
    assert explained_by(found) == ("mains_hum", "fixed_tones")
