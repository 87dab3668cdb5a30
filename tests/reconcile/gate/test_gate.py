"""The gate names what was done to a measurement, undoes what can be undone, and leaves real faults alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, lfilter, sosfilt

from reconcile.gate import FAULTS, inspect_measurement, time_stamp_findings
from signals.recording import Operating, Recording, Tacho
from sim.core.errors import SpecError
from sim.core.response import Channel

RATE_HZ = 16384.0
SECONDS = 2.25
TEETH = 23
SPEEDS_HZ = (20.3, 27.1)


def machine(
    speed_hz: float, seed: int, *, defect: float = 0.0, drift: float = 0.0, seconds: float = SECONDS
) -> Recording:
    """Three accelerometers hear mesh, shaft and noise through resonances of their own; `defect` adds impacts near the
    first, `drift` dB changes the level of single lines at random (a repeat is never the same)."""
    rng = np.random.default_rng(seed)
    n = int(RATE_HZ * seconds)
    angle = (
        2 * np.pi * np.cumsum(speed_hz * (1 + 3e-4 * lfilter([1e-3], [1, -0.999], rng.standard_normal(n)))) / RATE_HZ
    )
    levels = [1.0, 0.6, 0.4, 0.2, 0.1]
    lines = [(k * TEETH, a) for k, a in enumerate(levels, start=1)] + [(1, 0.3), (2, 0.1)]
    lines += [(k * TEETH + s, 0.15 * a) for k, a in enumerate(levels, start=1) for s in (-1, 1)]
    force = sum(a * 10 ** (drift * rng.standard_normal() / 20) * np.cos(o * angle + 0.7 * o) for o, a in lines)
    force = force + 0.3 * rng.standard_normal(n)
    pulses = np.zeros(n)
    pulses[np.flatnonzero(np.diff(np.floor(3.58 * angle / (2 * np.pi))) > 0)] = defect
    rows = []
    for c, (hz, share) in enumerate(((1800.0, 1.0), (2900.0, 0.3), (4300.0, 0.2))):
        modes = sosfilt(butter(1, [0.9 * hz, 1.1 * hz], "bandpass", fs=RATE_HZ, output="sos"), force + share * pulses)
        rows.append(2 * modes + (0.5 + 0.2 * c) * force + 0.02 * rng.standard_normal(n))
    channels = tuple(
        Channel(name=f"a{c}", quantity="acceleration", unit="m/s^2", location=f"bearing{c + 1}") for c in range(3)
    )
    turns = angle / (2 * np.pi)
    tacho = np.interp(np.arange(1, int(turns[-1])), turns, np.arange(n) / RATE_HZ)
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=channels,
        samples=np.asarray(rows),
        operating=Operating(shaft="input", speed_hz=speed_hz * 1.004),
        tacho=Tacho(shaft="input", pulse_times_s=tacho),
    )


BASELINES = tuple(machine(hz, seed) for seed, hz in enumerate(SPEEDS_HZ))


def trials(**how: float) -> tuple[Recording, ...]:
    return tuple(machine(hz, 100 + seed, drift=0.5, **how) for seed, hz in enumerate(SPEEDS_HZ))


def changed(row: int, change) -> tuple[Recording, ...]:  # type: ignore[no-untyped-def]
    result = []
    for i, r in enumerate(trials()):
        samples = r.samples.copy()
        samples[row] = change(samples[row], i)
        result.append(replace(r, samples=samples))
    return tuple(result)


def judged(tests):  # type: ignore[no-untyped-def]
    return inspect_measurement(BASELINES, tests, mesh_orders=(float(TEETH),), orders=(3.58, 5.42))


@pytest.mark.slow
def test_a_repeat_has_no_fault() -> None:
    assert judged(trials()).fault is None


@pytest.mark.slow
@pytest.mark.parametrize("size", [5.0, 60.0, 200.0])
def test_impacts_near_one_sensor_are_not_a_sensor_fault(size: float) -> None:
    gate = judged(trials(defect=size))
    assert gate.fault is None, gate.fault
    assert len(gate.tests[0].names) == 3


def _gap(x, i):  # type: ignore[no-untyped-def]
    x[5000:5200] = 0.0
    return x


def _away(x, i):  # type: ignore[no-untyped-def]
    for start in range(3000, x.size, 9000):
        x[start : start + 300] *= 0.003
    return x


def _stuck(x, i):  # type: ignore[no-untyped-def]
    x[7000:9000] = x[7000]
    return x


def _nan(x, i):  # type: ignore[no-untyped-def]
    x[100:120] = np.nan
    return x


def _loose(x, i):  # type: ignore[no-untyped-def]
    low = lfilter(*butter(2, 900.0, fs=RATE_HZ), x)
    ring = lfilter(*butter(1, [750.0, 1000.0], "bandpass", fs=RATE_HZ), x)
    return low + 4 * ring


def _ring(x, i):  # type: ignore[no-untyped-def]
    """A mount that has come loose: one narrow resonance."""
    return x + 6 * lfilter(*butter(1, [2950.0, 3150.0], "bandpass", fs=RATE_HZ), x)


def _hum(x, i):  # type: ignore[no-untyped-def]
    t = np.arange(x.size) / RATE_HZ
    return x + 0.4 * np.sin(2 * np.pi * 49.98 * t) + 0.1 * np.sin(2 * np.pi * 149.94 * t)


def _alias(x, i):  # type: ignore[no-untyped-def]
    t = np.arange(x.size) / RATE_HZ
    tacho = trials()[i].tacho
    assert tacho is not None
    turns = np.interp(t, tacho.pulse_times_s, np.arange(tacho.pulse_times_s.size))
    return x + sum(0.1 * np.cos(2 * np.pi * TEETH * k * turns) for k in (19, 20, 21, 22, 27, 28, 29))


KINDS = [
    ("dropouts", _gap),
    ("dropouts", _away),
    ("stuck", _stuck),
    ("not_finite", _nan),
    ("silence", lambda x, i: np.zeros_like(x)),
    ("stuck", lambda x, i: np.full_like(x, 0.1)),
    ("clipped", lambda x, i: np.clip(x, -1.5, 1.5)),
    ("clipped", lambda x, i: np.clip(x, -1.5, 1.5) + 1e-3 * np.sin(np.arange(x.size))),
    ("mains_hum", _hum),
    ("gain_change", lambda x, i: 1.6 * x),
    ("gain_change", lambda x, i: 0.5 * x),
    ("unit_mismatch", lambda x, i: x / 9.80665),
    ("loose_sensor", _loose),
    ("loose_sensor", _ring),
    ("alias", _alias),
]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "change"), KINDS)
def test_each_kind_is_named_at_its_channel(kind, change) -> None:  # type: ignore[no-untyped-def]
    gate = judged(changed(1, change))
    assert gate.fault is not None
    assert (gate.fault.kind, gate.fault.channel) == (kind, "a1")


@pytest.mark.slow
def test_swapped_channels_are_named_and_put_back() -> None:
    tests = trials()
    gate = judged(tuple(replace(t, samples=t.samples[[1, 0, 2]]) for t in tests))
    assert gate.fault is not None and gate.fault.kind == "swapped_channels"
    assert {f.channel for f in gate.findings if f.kind == "swapped_channels"} == {"a0", "a1"}
    assert np.array_equal(gate.tests[0].samples, tests[0].samples)


@pytest.mark.slow
def test_gain_is_undone() -> None:
    tests = trials()
    gate = judged(changed(1, lambda x, i: 1.6 * x))
    assert np.std(gate.tests[0].samples[1]) == pytest.approx(np.std(tests[0].samples[1]), rel=0.06)


@pytest.mark.slow
def test_a_loose_mount_is_equalised() -> None:
    gate = judged(changed(1, _loose))
    assert np.std(gate.tests[0].samples[1]) == pytest.approx(np.std(trials()[0].samples[1]), rel=0.35)


@pytest.mark.slow
def test_hum_is_taken_out() -> None:
    gate = judged(changed(1, _hum))
    left = gate.tests[0].samples[1] - trials()[0].samples[1]
    assert np.std(left) < 0.1 * 0.4 / np.sqrt(2)


@pytest.mark.slow
@pytest.mark.parametrize(("hz", "fault"), [((99.96,), False), ((99.96, 199.92), False), ((49.98, 99.96), True)])
def test_twice_the_supply_alone_may_be_the_pull_of_a_motor(hz: tuple[float, ...], fault: bool) -> None:
    """Without a baseline to tell whether it is new."""

    def hummed(x, i):  # type: ignore[no-untyped-def]
        return x + sum(0.4 * np.sin(2 * np.pi * f * np.arange(x.size) / RATE_HZ) for f in hz)

    gate = inspect_measurement((), changed(1, hummed), mesh_orders=(TEETH,))
    found = [f for f in gate.findings if f.kind == "mains_hum" and f.channel == gate.tests[0].names[1]]
    assert found and all(f.fault is fault for f in found)
    assert all(("pull of a motor" in f.detail) is not fault for f in found)


@pytest.mark.slow
def test_hum_that_the_baseline_has_too_is_a_remark() -> None:
    def hummed(r: Recording) -> Recording:
        samples = r.samples.copy()
        samples[0] = _hum(samples[0], 0)
        return replace(r, samples=samples)

    gate = inspect_measurement(tuple(map(hummed, BASELINES)), tuple(map(hummed, trials())), mesh_orders=(TEETH,))
    assert gate.fault is None
    assert any(f.kind == "mains_hum" for f in gate.findings)


@pytest.mark.slow
@pytest.mark.parametrize("error", [0.01, 0.05])
def test_a_jittering_tacho_is_named(error: float) -> None:
    rng = np.random.default_rng(5)
    tests = []
    for t in trials():
        assert t.tacho is not None
        pulses = t.tacho.pulse_times_s + error / t.tacho.pulse_times_s.size * SECONDS * rng.standard_normal(
            t.tacho.pulse_times_s.size
        )
        tests.append(replace(t, tacho=replace(t.tacho, pulse_times_s=pulses)))
    gate = judged(tuple(tests))
    assert gate.fault is not None and gate.fault.kind == "tacho_jitter"


@pytest.mark.slow
def test_missing_pulses_are_named() -> None:
    t = trials()[0]
    assert t.tacho is not None
    gate = judged((replace(t, tacho=replace(t.tacho, pulse_times_s=np.delete(t.tacho.pulse_times_s, [10, 31]))),))
    assert gate.fault is not None and gate.fault.kind == "tacho_jitter"


@pytest.mark.slow
def test_a_louder_machine_is_no_gain_fault() -> None:
    gate = judged(tuple(replace(t, samples=1.7 * t.samples) for t in trials()))
    assert gate.fault is None


def test_all_channels_silent_is_unusable() -> None:
    t = trials()[0]
    gate = judged((replace(t, samples=np.zeros_like(t.samples)),))
    assert not gate.usable
    assert gate.fault is not None and gate.fault.kind == "silence"


def test_a_short_record_and_a_wrong_label_are_remarks() -> None:
    t = replace(machine(21.5, 7), operating=Operating(shaft="input", speed_hz=20.0)).select(end_s=1.5)
    gate = inspect_measurement((), (t,), mesh_orders=(TEETH,), lowest_order=0.4)
    assert {f.kind for f in gate.findings} == {"too_short", "speed_mismatch"}
    assert gate.fault is None


def test_irregular_stamps() -> None:
    times = np.arange(1000) / 100.0
    assert time_stamp_findings(times, "test 1") == ()
    times[500:] += 0.2
    times[700] = times[699]
    (found,) = time_stamp_findings(times, "test 1")
    assert found.kind == "irregular_time" and found.fault and "sample 500" in found.where


def test_no_test_recording_is_refused() -> None:
    with pytest.raises(SpecError, match="tests"):
        inspect_measurement(BASELINES, ())


@pytest.mark.slow
def test_faults_are_ranked_by_what_spoils_first() -> None:
    def both(x, i):  # type: ignore[no-untyped-def]
        return _nan(_hum(x, i), i)

    gate = judged(changed(2, both))
    assert gate.fault is not None and gate.fault.kind == "not_finite"
    assert FAULTS.index("not_finite") < FAULTS.index("mains_hum")


def test_a_fraction_of_a_second_is_too_short_for_crests_and_says_so() -> None:
    rng = np.random.default_rng(3)

    def short(*, dull: bool) -> Recording:
        rows = rng.normal(size=(2, 14_400))
        if dull:
            rows[0] = lfilter([0.05], [1.0, -0.95], rows[0])
        channels = tuple(Channel(name=n, quantity="acceleration", unit="g", location="", axis="") for n in "ab")
        operating = Operating(shaft="shaft", speed_hz=29.95)
        return Recording(sampling_rate_hz=48_000.0, channels=channels, samples=rows, operating=operating)

    gate = inspect_measurement(
        [short(dull=False)], [short(dull=True)], orders=(), mesh_orders=(), lowest_order=1.0, seed=0
    )
    assert any(f.kind == "too_short" for f in gate.findings)
    assert any(f.kind == "loose_sensor" and f.channel == "a" for f in gate.findings)
