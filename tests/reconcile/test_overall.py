"""Overall levels: closed forms of a sine, baselines of the same operating point, and what says nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.overall import levels, with_levels
from reconcile.report.overall import overall
from reconcile.verdict import Report, Where
from signals.recording import Operating, Recording
from sim.core.response import Channel

RATE_HZ, SECONDS = 20480.0, 2.0
TIME = np.arange(round(RATE_HZ * SECONDS)) / RATE_HZ


def recorded(
    amplitude: float,
    hz: float = 100.0,
    *,
    speed_hz: float | None = 30.0,
    torque: float | None = None,
    unit: str = "m/s^2",
) -> Recording:
    quantity = {"m/s^2": "acceleration", "m": "displacement"}[unit]
    channel = Channel(name="a", quantity=quantity, unit=unit, location="bearing1", axis="y")
    operating = None if speed_hz is None else Operating(shaft="input", speed_hz=speed_hz, torque_nm=torque)
    samples = 3.0 + amplitude * np.sin(2.0 * np.pi * hz * TIME)[None, :]
    return Recording(sampling_rate_hz=RATE_HZ, channels=(channel,), samples=samples, operating=operating)


@pytest.mark.parametrize(("hz", "inside"), [(12.5, True), (100.0, True), (900.0, True), (1500.0, False), (5.0, False)])
def test_of_a_sine_both_levels_are_known(hz: float, inside: bool) -> None:
    (one,) = levels([recorded(2.0, hz)], [])
    assert one.now == pytest.approx(2.0 / np.sqrt(2.0), rel=1e-3) and one.before is None
    velocity = 2.0 / (2.0 * np.pi * hz) / np.sqrt(2.0)
    assert one.velocity_now is not None
    assert one.velocity_now == pytest.approx(velocity if inside else 0.0, rel=0.01, abs=0.01 * velocity)


def test_each_stands_beside_the_baseline_of_its_operating_point() -> None:
    tests = [recorded(2.0, speed_hz=30.1), recorded(4.0, speed_hz=22.5), recorded(4.0, speed_hz=45.0)]
    found = levels(tests, [recorded(1.0, speed_hz=22.5), recorded(0.5, speed_hz=30.0)])
    ratios = [None if one.before is None else one.now / one.before for one in found]
    assert ratios[:2] == pytest.approx([4.0, 4.0]) and ratios[2] is None
    assert [one.at for one in found] == ["30.1 Hz", "22.5 Hz", "45 Hz"]
    loads = levels([recorded(2.0, torque=20.0)], [recorded(1.0, torque=50.0), recorded(0.5, torque=20.5)])
    assert loads[0].before == pytest.approx(0.5 / np.sqrt(2.0), rel=1e-3) and loads[0].at == "30 Hz, 20 N m"
    assert levels([recorded(2.0, speed_hz=None)], [recorded(1.0)])[0].before is None


def test_of_several_baselines_the_nearest_counts_and_none_where_the_load_is_open() -> None:
    def before(test: Recording, *baselines: Recording) -> float | None:
        found = levels([test], list(baselines))[0].before
        return None if found is None else round(found * np.sqrt(2.0), 2)

    assert before(recorded(9.0), recorded(1.0, speed_hz=30.4), recorded(2.0, speed_hz=30.0)) == 2.0
    assert before(recorded(9.0), recorded(1.0, torque=20.0), recorded(2.0, torque=100.0)) is None
    assert before(recorded(9.0), recorded(1.0, torque=20.0)) == 1.0
    assert before(recorded(9.0, torque=-50.0), recorded(1.0, torque=50.0)) == 1.0
    assert before(recorded(9.0), replace(recorded(1.0), operating=Operating(shaft="output", speed_hz=30.0))) is None


def test_a_long_record_is_read_in_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = levels([recorded(2.0, 90.0)], [])[0].velocity_now
    monkeypatch.setattr("reconcile.overall.BLOCK_S", 0.5)
    (one,) = levels([recorded(2.0, 90.0)], [])
    assert whole is not None and one.velocity_now == pytest.approx(whole, rel=1e-3)


def test_what_is_no_number_is_left_out_and_no_velocity_made_of_a_displacement() -> None:
    spoiled = recorded(1.0)
    samples = spoiled.samples.copy()
    samples[0, 5] = np.nan
    assert levels([replace(spoiled, samples=samples)], []) == []
    assert levels([recorded(1.0, unit="m")], [])[0].velocity_now is None
    short = replace(spoiled, samples=spoiled.samples[:, : round(0.9 * RATE_HZ)])
    assert levels([short], [])[0].velocity_now is None, "nine periods of 10 Hz"


def test_the_page_tells_them_with_their_change() -> None:
    bare = Report(verdict="nothing_missing", sentence="so.", level="machine", where=Where())
    assert overall(bare) == ""
    said = overall(with_levels(bare, [recorded(2.0)], [recorded(1.0)]))
    assert "2 times (+6.0 dB)" in said and "ISO 20816-1" in said and "1.41 m/s²" in said
    alone = overall(with_levels(bare, [recorded(2.0, unit="m")], []))
    assert "change" not in alone.split("</p>")[0].split("<p")[0] and "velocity" not in alone.lower()


def test_a_baseline_at_another_speed_is_said_to_be_missing_here() -> None:
    report = Report(verdict="nothing_missing", sentence="Quiet.", level="kinematics", where=Where())
    said = "none was recorded at that speed and load"
    test, baseline = recorded(2.0, speed_hz=45.0), recorded(1.0, speed_hz=30.0)
    assert said in overall(with_levels(report, [test], [baseline]))
    for others in ([], [recorded(1.0, speed_hz=45.0)]):
        assert said not in overall(with_levels(report, [test], others))
