"""A force at a support of the simulated gearbox, told from what its sensors' lines gained."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import Point, at_point
from reconcile.machine import added_power, force
from reconcile.machine.added_power import CUT_OFF, _powers_by_newton, by_ways, gain_errors_db, reached, ways
from reconcile.machine.estimated import beside
from reconcile.machine.force import Heard, force_squares
from reconcile.observe.extract import extract, hann_spectrum, line_powers
from reconcile.observe.observation import PointData
from reconcile.observe.statistics import Statistics
from reconcile.observe.steady import Steady
from reconcile.speed import SpeedEstimate
from reconcile.verdict import LineChange
from sim.core.spec import CustomLaw, MachineSpec, TermSpec
from sim.presets import preset
from sim.solve.api import simulate

MACHINE = preset("paper-lightly-damped")
SENSORS = ("resonator1.y.acceleration", "resonator2.y.acceleration")
SITE, RATE = "bearing1", 20480.0
HZ = np.array([60.0, 150.0, 210.0, 690.0, 1380.0])


def with_sine(machine: MachineSpec, amplitude_n: float) -> MachineSpec:
    """Orders 2, 5 and 7 of the input shaft on the ring of the support, along y."""
    law = CustomLaw(
        name="own", dof=f"{SITE}.outer.y",
        expression=f"{amplitude_n}*(cos(2*phi)+0.5*cos(5*phi)+0.25*sin(7*phi))",
    )  # fmt: skip
    term = TermSpec(term="custom_force", site=SITE, parameters={"law": 1.0})
    return machine.model_copy(update={"custom_laws": [law], "terms": [term]})


def powers(machine: MachineSpec, channels: tuple[str, ...]) -> np.ndarray:
    found = simulate(machine, duration_s=1.2, output_rate_hz=RATE, channels=list(channels), seed=3)
    _, power, bin_hz = hann_spectrum(np.asarray(found.signals)[:, -int(RATE) :], RATE)
    return line_powers(power, bin_hz, HZ, np.zeros(HZ.size), 0.4 * RATE)


def responses(sensors: tuple[str, ...], machines: tuple[MachineSpec, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of all ways, its spread, and the axes told."""
    setting = SimpleNamespace(simulated=sensors)
    found = _powers_by_newton(setting, Point(speed_hz=30.0), SITE, machines, HZ)  # type: ignore[arg-type]
    assert found is not None
    return by_ways(found, np.ones((len(sensors), HZ.size), dtype=bool))


@pytest.mark.slow
@pytest.mark.parametrize("amplitude", [20.0, 200.0])
def test_the_force_of_a_simulated_machine_comes_back_line_by_line(
    amplitude: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever may hide at the teeth's strong lines."""
    monkeypatch.setattr(force, "MIXED", 0.0)
    machine = at_point(MACHINE, Point(speed_hz=30.0))
    before = powers(machine, SENSORS)
    with_law = powers(with_sine(machine, amplitude), (*SENSORS, f"{SITE}.custom.own.force"))
    response, spread, along = responses(SENSORS, (machine,))
    assert along.tolist() == [[False] * HZ.size, [True] * HZ.size], "along x nothing is heard"
    assert np.all(response[0] == response[-1])
    heard = Heard(test=with_law[:2], before=before, deviation=0.2 * before + 1e-12, response=response, spread_db=spread)
    found = force_squares(heard)
    true = np.sqrt(with_law[2])
    assert true[:3] == pytest.approx(amplitude * np.array([1.0, 0.5, 0.25]) / np.sqrt(2.0), rel=0.01)
    ratio = np.sqrt(found.best[:3]) / true[:3]
    assert np.all((ratio > 0.6) & (ratio < 1.6)), ratio
    assert np.all((np.sqrt(found.low) <= true) & (true <= np.sqrt(found.high)))
    wrong = force_squares(
        Heard(test=before, before=before, deviation=heard.deviation, response=response, spread_db=spread)
    )
    assert np.all(wrong.low == 0.0)


def test_a_channel_far_from_the_support_is_cut_off_where_nothing_reaches_it() -> None:
    """The output shaft hears a force on the input shaft by the teeth alone, and not below their resonances."""
    response, _, _ = responses(("resonator1.y.acceleration", "resonator3.y.acceleration"), (MACHINE,))
    own, far = response[-1]
    assert np.all(np.isfinite(own)) and np.isnan(far[0]) and np.isfinite(far[3])
    assert far[3] >= 0.1 * CUT_OFF * own[3]


def test_machines_that_differ_spread_the_response() -> None:
    softer = MACHINE.model_copy(deep=True)
    for one in softer.bearings:
        assert one.support is not None
        one.support.__dict__["stiffness_y_n_per_m"] *= 0.7
    _, alone, _ = responses(SENSORS, (MACHINE,))
    _, both, _ = responses(SENSORS, (MACHINE, softer))
    assert np.all(alone == 0.0) and np.all(both > 0.0)


def test_the_gain_is_known_where_lines_tell_it_and_nowhere_else() -> None:
    lines = np.array([700.0, 1400.0, 2100.0])
    model = np.array([[1.0, 1.0, 1.0], [1.0, 1.0, 1.0]])
    off = np.array([[1.0, 1.0, 1.0], [10.0, 0.1, 10.0]])
    seen = SimpleNamespace(line=model * off + 1e-9, resolution_hz=1.0)
    chain = SimpleNamespace(
        line_noise=lambda hz: np.full((2, hz.size), 1e-10), line_gain=lambda hz: np.ones((2, hz.size))
    )
    setting = SimpleNamespace(
        data=(SimpleNamespace(baseline=seen, test=seen, lines_hz=lines),),
        seen_through=(SimpleNamespace(chain=chain),), channels=("a", "b"),
    )  # fmt: skip
    healthy = SimpleNamespace(line=model, line_spread_db=np.full((2, 3), 1.0))
    found = gain_errors_db(setting, [healthy], np.array([50.0, 700.0, 1400.0]))  # type: ignore[arg-type, list-item]
    assert np.all(np.isnan(found[:, 0])) and np.all(np.isfinite(found[:, 1:]))
    assert np.all(found[1, 1:] > found[0, 1:]), "lines off the smooth gain say less"


def powers_of(x: list[float], y: list[float]) -> np.ndarray:
    """One machine, one line, channels that hear so much of either axis; the ring 1 of each."""
    channels = np.stack([x, y], axis=1)[:, None, :]
    return np.concatenate([channels, np.eye(2)[:, None, :]])[None]


def test_a_channel_that_hears_both_axes_hears_each_direction_otherwise() -> None:
    response, _, along = by_ways(powers_of([1.0], [0.4]), np.ones((1, 1), dtype=bool))
    assert along.tolist() == [[True], [True]]
    assert response[[0, -1], 0, 0] == pytest.approx([1.0, 0.4]) and len(response) == len(ways())
    assert response[len(response) // 2, 0, 0] == pytest.approx(0.7)
    response, _, along = by_ways(powers_of([1.0], [0.05]), np.ones((1, 1), dtype=bool))
    assert along.tolist() == [[True], [False]] and np.all(response == response[0]), "hardly heard, so not counted"
    response, _, along = by_ways(powers_of([1.0, 0.0], [0.05, 1.0]), np.array([[True], [False]]))
    assert along.tolist() == [[True], [False]], "the other channel's gain is not known"


LINES_HZ = np.array([690.0, 1380.0, 2070.0])


def recorded(speed_hz: float, tones: dict[float, float], noise: float, seed: int) -> Steady:
    """Amplitudes by order, in noise of so much rms, of one channel."""
    rng, t = np.random.default_rng(seed), np.arange(int(2 * RATE)) / RATE
    wave = sum(a * np.sin(2 * np.pi * order * speed_hz * t + order) for order, a in tones.items())
    wave = np.asarray(wave + noise * rng.normal(size=t.size))[None]
    estimate = SpeedEstimate(
        shaft="input", speed_hz=speed_hz, low_hz=speed_hz, high_hz=speed_hz, confidence=1.0, method="harmonics",
        stated_hz=30.0,
    )  # fmt: skip
    return Steady(samples=wave, rate_hz=RATE, speed_hz=speed_hz, estimate=estimate)


def setting_of(test: Steady, baseline: Steady, monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """One channel that hears a force on the ring as 1 m/s^2 a newton and whose gain is known; three watched lines."""

    def seen(one: Steady) -> Statistics:
        lines = LINES_HZ * one.speed_hz / 30.0
        none = np.zeros(0)
        return extract(
            one.samples, RATE, lines_hz=lines, line_slack=np.zeros(3), modulations_hz=none, modulation_slack=none
        )

    data = PointData(
        point=Point(speed_hz=30.0), lines_hz=LINES_HZ, modulations_hz=np.zeros(0), test=seen(test),
        halves=(seen(test),) * 2, baseline=seen(baseline), spectra=(test, baseline),
    )  # fmt: skip
    monkeypatch.setattr(
        added_power, "_powers_by_newton",
        lambda _s, _p, _site, _m, hz: np.broadcast_to(np.eye(2)[[0, 0, 1], None, :], (1, 3, hz.size, 2)),
    )  # fmt: skip
    monkeypatch.setattr(added_power, "gain_errors_db", lambda _s, _h, hz: np.zeros((1, hz.size)))
    monkeypatch.setattr(added_power, "slack", lambda _watched, hz: np.zeros(hz.size))
    chain = SimpleNamespace(line_gain=lambda hz: np.ones((1, hz.size)))
    null = np.random.default_rng(1).normal(0.0, 0.5, (40, 3))
    return SimpleNamespace(
        data=(data,), seen_through=(SimpleNamespace(chain=chain),), machine=MACHINE, channels=("a",),
        changes=SimpleNamespace(null=null, starts=(0, 3)),
    )  # fmt: skip


def test_a_line_beside_the_watched_ones_is_read_in_each_recording_at_its_own_speed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The baseline turned 1 % slower: its line of order 7.3 stands elsewhere and has not changed."""
    tones = {7.3: 1.0, 23.0: 1.0}
    setting = setting_of(recorded(30.15, tones, 0.01, 1), recorded(29.85, tones, 0.01, 2), monkeypatch)
    risen = [
        LineChange(label="", frequency_hz=7.3 * 30.15, change_db=20.0, speed_hz=30.15),
        LineChange(label="", frequency_hz=23.0 * 30.15, change_db=20.0, speed_hz=30.0),
    ]
    asked = beside(setting.data, 0, risen)
    assert asked == pytest.approx([7.3 * 30.0]), "the watched line is not asked again"
    found = reached(setting, 0, SITE, (), (), beside_hz=asked)  # type: ignore[arg-type]
    assert found is not None and found.axes == ("x",)
    k = int(np.argmin(np.abs(found.hz - 219.0)))
    assert found.heard.test[0, k] == pytest.approx(0.5, rel=0.02)
    assert found.heard.before[0, k] == pytest.approx(0.5, rel=0.02)
    assert not force_squares(found.heard).rose.any()


@pytest.mark.slow
@pytest.mark.parametrize("louder_db", [0.0, 10.0, 20.0])
def test_a_noise_that_rose_is_no_force_at_lines(louder_db: float, monkeypatch: pytest.MonkeyPatch) -> None:
    rose = 0
    for seed in range(8):
        noise, tones = 0.05, {23.0: 1.0, 46.0: 0.01}
        test = recorded(30.0, tones, noise * 10.0 ** (louder_db / 20.0), 2 * seed)
        setting = setting_of(test, recorded(30.0, tones, noise, 2 * seed + 1), monkeypatch)
        found = reached(setting, 0, SITE, (), (), beside_hz=[219.0, 333.0])  # type: ignore[arg-type]
        assert found is not None
        rose += int(force_squares(found.heard).rose.sum())
    assert rose <= 2, "of forty lines"


def test_a_tone_that_rose_in_noise_is_told_and_channels_that_are_not_asked_tell_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    setting = setting_of(recorded(30.0, {23.0: 4.0}, 0.05, 1), recorded(30.0, {23.0: 0.5}, 0.05, 2), monkeypatch)
    found = reached(setting, 0, SITE, (), ())  # type: ignore[arg-type]
    assert found is not None
    squares = force_squares(found.heard)
    assert squares.rose.tolist() == [True, False, False]
    assert squares.low[0] < 8.0 < squares.high[0]
    deaf = reached(setting, 0, SITE, (), (), told_by=[False])  # type: ignore[arg-type]
    assert deaf is not None and deaf.axes == () and np.isnan(force_squares(deaf.heard).high).all()
