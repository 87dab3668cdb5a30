"""Time stamps: the rate they give, irregular ones wherever they stand, and rates that contradict them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sim.core.errors import SpecError

RATE, N = 1000.0, 400


def refusal(call: Any, *arguments: Any, **options: Any) -> str:
    with pytest.raises(SpecError) as caught:
        call(*arguments, **options)
    return str(caught.value)


def stamped(folder: Path, times: np.ndarray) -> Path:
    np.savez(folder / "t.npz", a=np.sin(times), b=np.cos(times), clock=times, time_s=times)
    return folder / "t.npz"


def test_time_stamps_give_the_rate_and_the_start(read, tmp_path) -> None:
    path = stamped(tmp_path, 5 + np.arange(N) / RATE)
    found = read(path, sampling_rate_hz=..., time={"column": "clock"}).recording
    assert found.sampling_rate_hz == pytest.approx(RATE)
    assert found.start_s == pytest.approx(5)
    assert "mean rate" in refusal(read, path, sampling_rate_hz=1100, time={"column": "clock"})


@pytest.mark.parametrize("mentioned", [True, False])
def test_irregular_time_stamps_are_refused_with_where(read, tmp_path, mentioned: bool) -> None:
    times = np.arange(N) / RATE
    times[100:] += 0.02
    path = stamped(tmp_path, times)
    text = refusal(read, path, time={"column": "clock"} if mentioned else ...)
    assert "irregular from sample 100" in text and "1 gaps" in text


def test_stamps_rounded_when_printed_are_regular(read, tmp_path) -> None:
    times = np.round(100 + np.arange(N) / RATE, 2)
    assert read(stamped(tmp_path, times), time={"column": "clock"}).recording.samples.shape == (2, N)


def with_time(folder: Path, name: str, times: np.ndarray) -> Path:
    np.savez(folder / "u.npz", a=np.sin(times), b=np.cos(times), **{name: times})
    return folder / "u.npz"


HEADINGS = ["Time", "TIME", "time (s)", "Time [s]", "Timestamp", "seconds", "X_Value", "t"]


@pytest.mark.parametrize("heading", HEADINGS)
@pytest.mark.parametrize("fmt", ["csv", "npz"])
def test_irregular_stamps_are_found_however_their_column_is_headed(read, tmp_path, heading: str, fmt: str) -> None:
    times = np.arange(N) / RATE
    columns = {"a": np.sin(times), "b": np.cos(times)}
    for late, ok in ((0.02, False), (0.0, True)):
        times[100:] += late
        path = tmp_path / f"{late}.{fmt}"
        if fmt == "npz":
            np.savez(path, **columns, **{heading: times})
        else:
            header = ",".join((heading, *columns))
            np.savetxt(path, np.column_stack((times, *columns.values())), delimiter=",", header=header, comments="")
        if ok:
            times[100:] -= 0.02
            continue
        assert "irregular from sample 100" in refusal(read, path)
    times = np.arange(N) / RATE
    np.savez(tmp_path / "regular.npz", **columns, **{heading: times})
    found = read(tmp_path / "regular.npz")
    assert found.recording.sampling_rate_hz == RATE and not [r for r in found.remarks if heading in r]


def test_a_time_by_its_unit_must_be_regular_if_it_rises(read, tmp_path) -> None:
    times = np.arange(N) / RATE
    times[100:] += 0.02
    for values, refused in ((times, True), (times[::-1], False)):
        table = np.column_stack((values, np.sin(times), np.cos(times)))
        np.savetxt(tmp_path / "r.csv", table, delimiter=",", header="moment [s],a,b", comments="")
        if refused:
            assert "irregular from sample 100" in refusal(read, tmp_path / "r.csv")
        else:
            assert read(tmp_path / "r.csv")


def test_a_first_column_that_rises_unevenly_is_told_of(read, tmp_path) -> None:
    times = np.arange(N) / RATE
    times[100:] += 0.02
    table = np.column_stack((times, np.sin(times), np.cos(times)))
    np.savetxt(tmp_path / "r.csv", table, delimiter=",", header="moment,a,b", comments="")
    assert any(r.startswith("moment: rises throughout") for r in read(tmp_path / "r.csv").remarks)


@pytest.mark.parametrize("ends", [(-1e308, 1e308), (0.0, np.inf), (np.nan, 1.0)])
def test_a_first_column_of_any_numbers_is_no_matter(read, tmp_path, ends: tuple[float, float]) -> None:
    t = np.arange(N) / RATE
    first = np.where(np.arange(N) < N // 2, *ends)
    np.savetxt(tmp_path / "r.csv", np.column_stack((first, t, t)), delimiter=",", header="q,a,b", comments="")
    assert read(tmp_path / "r.csv").recording.samples.shape == (2, N)


def test_temperatures_called_t_are_no_time(read, tmp_path) -> None:
    t = np.arange(N) / RATE
    table = np.column_stack((20 + np.sin(t), np.sin(t), np.cos(t)))
    np.savetxt(tmp_path / "r.csv", table, delimiter=",", header="t [degC],a,b", comments="")
    assert read(tmp_path / "r.csv").recording.samples.shape == (2, N)


@pytest.mark.parametrize("rate", [1e308, 1e-300, 1.1e9, 9e-4])
def test_a_rate_that_no_recording_has_is_refused_wherever_it_stands(read, tmp_path, rate: float) -> None:
    t = np.arange(N) / RATE
    np.savez(tmp_path / "r.npz", a=np.sin(t), b=np.cos(t), sampling_rate_hz=rate)
    assert "sampling_rate_hz" in refusal(read, tmp_path / "r.npz", sampling_rate_hz=...)
    assert "0.001 to 1e+09" in refusal(read, tmp_path / "r.npz")
    np.savez(tmp_path / "s.npz", a=np.sin(t), b=np.cos(t), clock=np.arange(N) / rate)
    assert "time" in refusal(read, tmp_path / "s.npz", sampling_rate_hz=..., time={"column": "clock"})
    with pytest.raises(SpecError, match="sampling_rate_hz"):
        read(tmp_path / "s.npz", sampling_rate_hz=rate)


@pytest.mark.parametrize("name", ["time", "t", "timestamp"])
@pytest.mark.parametrize("per_s", [1.0, 1e3, 1e6, 1e9])
def test_stamps_in_no_stated_unit_that_contradict_the_rate_are_refused(read, tmp_path, name: str, per_s: float) -> None:
    path = with_time(tmp_path, name, 5 + np.arange(N) / 25600.0 * per_s)
    text = refusal(read, path, sampling_rate_hz=12800.0)
    assert (
        "sampling_rate_hz" in text and "12800" in text and "25600" in text and repr(name) in text and "`time`" in text
    )
    assert read(path, sampling_rate_hz=25600.0).recording.sampling_rate_hz == 25600.0


def test_a_rate_of_the_file_is_held_against_its_stamps(read, tmp_path) -> None:
    times = np.arange(N) / 25600.0
    np.savez(tmp_path / "u.npz", a=np.sin(times), b=np.cos(times), t=times, sampling_rate_hz=12800.0)
    assert "25600" in refusal(read, tmp_path / "u.npz", sampling_rate_hz=...)


def test_stamps_that_contradict_a_rate_can_be_stated_with_their_unit(read, tmp_path) -> None:
    path = with_time(tmp_path, "time", np.arange(N) / 25600.0 * 60)
    assert "'time'" in refusal(read, path, sampling_rate_hz=25600.0)
    stated = {"column": "time", "unit": "s"}
    assert read(path, sampling_rate_hz=..., time=stated).recording.sampling_rate_hz == pytest.approx(25600.0 / 60)


@pytest.mark.parametrize(
    "times",
    [
        np.arange(N),
        7 + np.arange(N),
        np.round(np.arange(N) / 25600.0, 6),
        np.round(np.arange(N) / 25600.0, 4),
        np.round(np.arange(N) / 25600.0 * 1e6),
        1.7e9 + np.arange(N) / 25600.0,
        np.arange(N) / 25600.0 * 1.005,
    ],
    ids=["count", "count from 7", "us", "100 us", "whole us", "since 1970", "drift"],
)
def test_counters_and_rounded_stamps_agree_with_a_rate(read, tmp_path, times: np.ndarray) -> None:
    assert read(with_time(tmp_path, "t", times), sampling_rate_hz=25600.0).recording.sampling_rate_hz == 25600.0


@pytest.mark.parametrize(("off", "refused"), [(0.004, False), (0.008, False), (0.013, True), (0.05, True)])
def test_a_rate_is_held_to_stamps_within_what_clocks_drift(read, tmp_path, off: float, refused: bool) -> None:
    path = with_time(tmp_path, "t", np.arange(N) / 25600.0 * (1 + off))
    if refused:
        assert "'t'" in refusal(read, path, sampling_rate_hz=25600.0)
    else:
        assert read(path, sampling_rate_hz=25600.0).recording.sampling_rate_hz == 25600.0
