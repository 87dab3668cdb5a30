"""The entry point: channels, sampling, refusals, cancelling, divergence."""

from __future__ import annotations

import numpy as np
import pytest

from sim.core.errors import Cancelled, Diverged, SpecError, TooStiff, UnknownName
from sim.core.spec import MachineSpec, TermSpec
from sim.presets import preset
from sim.solve.api import estimate_cost, simulate
from sim.solve.settings import Settings
from tests.strategies.systems import with_terms

QUICK = Settings(estimate_error=False)


def test_samples_start_at_zero_and_count_rate_times_duration():
    response = simulate(preset("oscillator"), duration_s=0.0101, output_rate_hz=1000.0, settings=QUICK)
    assert response.signals.shape == (1, 11)
    assert response.channels[0].name == "mass.y.acceleration"


def test_the_same_request_gives_the_same_bits():
    runs = [simulate(preset("paper-demo"), duration_s=0.01, output_rate_hz=12_000.0, settings=QUICK) for _ in range(2)]
    assert np.array_equal(runs[0].signals, runs[1].signals)


def test_every_channel_is_finite_and_named_once():
    response = simulate(
        preset("paper-demo"), duration_s=0.01, output_rate_hz=12_000.0, channels=("all",), settings=QUICK
    )
    assert np.all(np.isfinite(response.signals))
    assert len({c.name for c in response.channels}) == len(response.channels) == response.signals.shape[0]


def test_channels_do_not_disturb_each_other():
    everything = simulate(preset("rotor"), duration_s=0.01, output_rate_hz=6_000.0, channels=("all",), settings=QUICK)
    alone = simulate(
        preset("rotor"), duration_s=0.01, output_rate_hz=6_000.0, channels=("disc.y.velocity",), settings=QUICK
    )
    assert np.array_equal(alone.signals[0], everything.signal("disc.y.velocity"))


def test_acceleration_is_the_derivative_of_velocity():
    response = simulate(
        preset("rotor"),
        duration_s=0.02,
        output_rate_hz=120_000.0,
        channels=("disc.y.velocity", "disc.y.acceleration"),
        settings=Settings(estimate_error=False, anti_alias=False, steps_per_output=1),
    )
    slope = np.gradient(response.signals[0], 1.0 / 120_000.0)[2:-2]
    assert slope == pytest.approx(response.signals[1, 2:-2], abs=2e-3 * np.max(np.abs(response.signals[1])))


def test_unknown_channel_lists_what_exists():
    with pytest.raises(UnknownName) as caught:
        simulate(preset("oscillator"), duration_s=0.1, output_rate_hz=1000.0, channels=("mass.z.velocity",))
    assert "mass.y.velocity" in caught.value.known


@pytest.mark.parametrize(
    ("duration_s", "rate_hz", "field"),
    [
        (0.0, 1e3, "duration_s"),
        (float("nan"), 1e3, "duration_s"),
        (4000.0, 1e3, "duration_s"),
        (1.0, 1.0, "sampling_rate_hz"),
        (1.0, float("inf"), "sampling_rate_hz"),
        (0.001, 1000.0, "duration_s"),
    ],
)
def test_impossible_requests_name_the_field(duration_s, rate_hz, field):
    for call in (simulate, estimate_cost):
        with pytest.raises(SpecError) as caught:
            call(preset("oscillator"), duration_s=duration_s, output_rate_hz=rate_hz)
        assert field in [p.field for p in caught.value.problems]


def test_cancelling_stops_between_blocks():
    asked = []

    def cancelled():
        asked.append(None)
        return len(asked) > 2

    with pytest.raises(Cancelled, match="cancelled at t = "):
        simulate(preset("oscillator"), duration_s=60.0, output_rate_hz=1000.0, settings=QUICK, cancelled=cancelled)
    assert len(asked) == 3


def test_progress_rises_to_one():
    seen = []
    simulate(preset("oscillator"), duration_s=1.0, output_rate_hz=1000.0, settings=QUICK, progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == pytest.approx(1.0)
    assert len(seen) > 3


def falling():
    """A rotor whose outer rings stand on next to nothing (nothing at all is refused): it falls freely past a metre."""
    machine = preset("rotor")
    loose = machine.bearings[0].support.model_copy(
        update={"stiffness_x_n_per_m": 1e-3, "stiffness_y_n_per_m": 1e-3, "damping_y_ns_per_m": 0.0}
    )
    return machine.model_copy(update={"bearings": [b.model_copy(update={"support": loose}) for b in machine.bearings]})


def test_divergence_says_when_and_where():
    with pytest.raises(Diverged) as caught:
        simulate(falling(), duration_s=2.0, output_rate_hz=2000.0, settings=QUICK)
    # free fall passes a metre after sqrt(2 / g) s; blocks of the loop delay the notice
    assert np.sqrt(2.0 / 9.80665) <= caught.value.time_s < 1.0
    assert caught.value.dof.endswith(".y")
    assert "t = " in str(caught.value)
    assert "step" in caught.value.advice


def test_a_run_is_given_up_that_takes_more_iterations_than_allowed():
    machine, asked = preset("paper-demo"), {"duration_s": 0.6, "output_rate_hz": 12_000.0}
    free = simulate(machine, settings=QUICK, **asked)
    allowed = simulate(machine, settings=Settings(estimate_error=False, most_iterations=20.0), **asked)
    assert np.array_equal(free.signals, allowed.signals)
    with pytest.raises(TooStiff, match=r"given up at t = .* s: .* iterations a step, where 0.5 were allowed") as caught:
        simulate(machine, settings=Settings(estimate_error=False, most_iterations=0.5), **asked)
    assert 0.0 < caught.value.time_s < 0.3, "long before its end"


def test_seeds_matter_where_something_is_random():

    machine = with_terms(preset("paper-lightly-damped"), TermSpec(term="pitch_error", site="pinion"))
    runs = [
        simulate(machine, duration_s=0.01, output_rate_hz=6000.0, seed=k, settings=QUICK).signals for k in (1, 1, 2)
    ]
    assert np.array_equal(runs[0], runs[1])
    assert not np.array_equal(runs[0], runs[2])


def test_cost_grows_with_duration():
    short, long = (estimate_cost(preset("paper"), duration_s=d, output_rate_hz=12_000.0) for d in (1.0, 10.0))
    assert long.steps == 10 * short.steps
    assert long.seconds > 5 * short.seconds


def test_leaving_the_stiffness_table_is_said():
    machine = preset("paper")
    data = machine.model_dump()
    small = np.linspace(-1e-9, 1e-9, 3)
    data["meshes"][0]["table"] = {
        "centre_distance_error_m": small.tolist(),
        "stiffness_n_per_m": np.full((3, 64), 3.9e8).tolist(),
    }
    found = simulate(MachineSpec.model_validate(data), duration_s=0.02, output_rate_hz=20_000.0)
    assert any("left the range of its stiffness table" in text for text in found.warnings)
    inside = simulate(machine, duration_s=0.02, output_rate_hz=20_000.0)
    assert not any("left the range" in text for text in inside.warnings)
