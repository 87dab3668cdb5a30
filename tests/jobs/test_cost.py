"""The estimate before acceptance, against the work that is then counted: steps and iterations, not time."""

from __future__ import annotations

import pytest

from bench.work import count_work
from jobs.cost import CALIBRATION, KINDS, Run, calibration, counted, expected
from signals.overrides import apply_overrides
from sim import presets
from sim.assembly.assemble import assemble
from sim.core.system import System

RATE_HZ, DURATION_S, FACTOR = 30_000.0, 0.3, 2.0
GAPS = {f"fit_clearance@bearing{i}.gap": 2e-5 for i in (1, 2, 3, 4)}
MACHINES: list[tuple[str, dict[str, object]]] = [
    *((name, {}) for name in presets.names()),
    ("paper", {"fit_clearance@bearing1.gap": 1e-4}),
    ("paper", GAPS),
    ("paper", {"operating.speed_hz": 90.0}),
    ("rotor", {"fit_clearance@bearing1.gap": 2e-5}),
]


def system(name: str, change: dict[str, object]) -> System:
    return assemble(apply_overrides(presets.preset(name), change))


@pytest.mark.slow
@pytest.mark.parametrize(("name", "change"), MACHINES)
def test_estimated_work_is_within_a_factor_of_two(name: str, change: dict[str, object]) -> None:
    machine = system(name, change)
    told = expected(machine, Run(duration_s=DURATION_S, sampling_rate_hz=RATE_HZ, channels=1))
    done = count_work(machine, DURATION_S, RATE_HZ)
    assert 1 / FACTOR <= told.steps / done.steps <= FACTOR
    assert 1 / FACTOR <= told.iterations / done.iterations <= FACTOR


def test_the_calibration_is_whole_and_says_how_it_was_measured() -> None:
    figures = calibration()
    assert set(figures.iterations) == set(figures.refinement) == set(KINDS)
    assert min(*figures.iterations.values(), *figures.refinement.values()) >= 1.0
    assert min(*figures.step_seconds.values(), *figures.rest_seconds.values()) >= 0.0
    assert '"measured_by": "python -m bench.cost"' in CALIBRATION.read_text(encoding="utf-8")


def test_elements_are_counted_by_kind() -> None:
    assert counted(system("paper-demo", {})) == {"mesh": 1, "ball": 4, "wall": 1, "other": 0}
    assert counted(system("oscillator", {})) == {"mesh": 0, "ball": 0, "wall": 0, "other": 0}


def test_seconds_grow_with_everything_that_costs() -> None:
    paper, walls = system("paper", {}), system("paper", GAPS)
    base = expected(paper, Run(duration_s=1.0, sampling_rate_hz=RATE_HZ, channels=4)).seconds
    assert expected(paper, Run(duration_s=5.0, sampling_rate_hz=RATE_HZ, channels=4)).seconds > 2 * base
    assert expected(paper, Run(duration_s=1.0, sampling_rate_hz=RATE_HZ, channels=100)).seconds > base
    assert expected(walls, Run(duration_s=1.0, sampling_rate_hz=RATE_HZ, channels=4)).seconds > base
