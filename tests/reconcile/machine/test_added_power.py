"""A force at a support of the simulated gearbox, told from what its sensors' lines gained."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import Point, at_point
from reconcile.machine.added_power import CUT_OFF, _by_axis, _responses, gain_errors_db
from reconcile.machine.force import Heard, force_squares
from reconcile.observe.extract import hann_spectrum, line_powers
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


def responses(sensors: tuple[str, ...], machines: tuple[MachineSpec, ...]) -> tuple[np.ndarray, np.ndarray]:
    setting = SimpleNamespace(simulated=sensors)
    found = _responses(setting, Point(speed_hz=30.0), SITE, machines, HZ)  # type: ignore[arg-type]
    assert found is not None
    return _by_axis(found)


@pytest.mark.slow
@pytest.mark.parametrize("amplitude", [20.0, 200.0])
def test_the_force_of_a_simulated_machine_comes_back_line_by_line(amplitude: float) -> None:
    machine = at_point(MACHINE, Point(speed_hz=30.0))
    before = powers(machine, SENSORS)
    with_law = powers(with_sine(machine, amplitude), (*SENSORS, f"{SITE}.custom.own.force"))
    response, spread = responses(SENSORS, (machine,))
    assert np.isnan(response[0]).all(), "along x nothing is heard"
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
    response, _ = responses(("resonator1.y.acceleration", "resonator3.y.acceleration"), (MACHINE,))
    own, far = response[1]
    assert np.all(np.isfinite(own)) and np.isnan(far[0]) and np.isfinite(far[3])
    assert far[3] >= 0.1 * CUT_OFF * own[3]


def test_machines_that_differ_spread_the_response() -> None:
    softer = MACHINE.model_copy(deep=True)
    for one in softer.bearings:
        assert one.support is not None
        one.support.__dict__["stiffness_y_n_per_m"] *= 0.7
    _, alone = responses(SENSORS, (MACHINE,))
    _, both = responses(SENSORS, (MACHINE, softer))
    assert np.all(alone[1] == 0.0) and np.all(both[1] > 0.0)


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
