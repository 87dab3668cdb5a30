"""Impacts at a multiple of the supply's frequency name no part; a defect that slips, or is modulated, is named."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import fftconvolve

from reconcile.kinematics import read_kinematic_spec
from reconcile.kinematics.families import ties
from reconcile.kinematics.mains import Electric, electric, electric_report, named_but_supply
from reconcile.kinematics.observe import observe
from reconcile.verdict import Report
from signals.recording import Recording
from signals.series import FloatArray
from tests.strategies.brief import RATE_HZ, SECONDS, N, recorded, shaft_lines

SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)
TIE = ties(SPEC)
OUTER, INNER = 28.1, 18.6
"""Speeds at which the outer race is struck 100.7 times a second by the drawing, the inner one as often."""


def struck(rate_hz: float, seed: int, speed_hz: float = OUTER, *, height: float = 4.0, load: float = 0.0) -> Recording:
    """Blows `rate_hz` times a second (0: none), some early or late, stronger with 1 + load cos(shaft)."""
    rng = np.random.default_rng(seed)
    force: FloatArray = np.zeros(N)
    count = int((SECONDS - 0.03) * rate_hz)
    times = 0.005 + (np.arange(count) + 0.01 * rng.standard_normal(count)) / max(rate_hz, 1.0)
    size = height * (1 + load * np.cos(2 * np.pi * speed_hz * times))
    np.add.at(force, (times * RATE_HZ).astype(int), size)
    ring = np.arange(int(0.01 * RATE_HZ)) / RATE_HZ
    rung = fftconvolve(force, np.exp(-ring * 1800) * np.sin(2 * np.pi * 4200 * ring))[:N]
    return recorded(rung + shaft_lines(rng, speed_hz) + 0.3 * rng.standard_normal(N), speed_hz)


def judged(*tests: Recording) -> tuple[list[str], Electric | None, Report | None]:
    """(parts that are named, what the supply makes, what is said of that), beside a sound baseline at each speed."""
    seen = [observe(t, TIE, f"test {i}", stated_hz=None, seed=0) for i, t in enumerate(tests, 1)]
    sound = [struck(0.0, 90 + i, t.speed.speed_hz) for i, t in enumerate(seen)]
    past = [observe(b, TIE, f"baseline {i}", stated_hz=None, seed=0) for i, b in enumerate(sound, 1)]
    chosen, every, supply = named_but_supply(seen, past, TIE, 0)
    assert not {c.family.key for c in every if c.present} & {c.family.key for c, _ in supply}
    found = electric(supply, True)
    return [c.family.key for c in chosen], found, None if found is None else electric_report(found, seen, past)


@pytest.mark.slow
def test_the_supply_is_no_outer_race() -> None:
    parts, found, report = judged(struck(100.0, 1))
    assert parts == [] and found is not None and found.rate_hz == 100.0 and found.parts == ("bearing1.outer",)
    assert report is not None and report.verdict == "not_decidable" and not report.causes
    assert [round(line.frequency_hz) for line in report.where.lines] == [100, 200, 300]
    assert report.next_experiment is not None and "another speed" in report.next_experiment.sentence


@pytest.mark.slow
@pytest.mark.parametrize("rate_hz", [99.4, 100.6])
def test_a_race_beside_the_supply_is_named(rate_hz: float) -> None:
    assert judged(struck(rate_hz, 2)) == (["bearing1.outer"], None, None)


@pytest.mark.slow
def test_sidebands_of_the_shaft_are_no_supplys() -> None:
    assert judged(struck(100.0, 3, INNER, load=0.8))[:2] == (["bearing1.inner"], None)


@pytest.mark.slow
def test_at_two_speeds_the_supply_alone_keeps_its_rate() -> None:
    parts, _, report = judged(struck(100.0, 4), struck(100.0, 5), struck(100.0, 6, 23.1))
    assert parts == [] and report is not None and report.verdict == "measurement_fault"
    assert report.fault is not None and report.fault.kind == "mains_hum" and not report.causes
