"""Events of made-up contacts at known times."""

import numpy as np
import pytest

from signals.impacts import Contact, ContactImpacts, find_impacts, fold
from signals.series import FloatArray

RATE, SECONDS, STRUCK_HZ, SHAFT_HZ = 20_000.0, 2.0, 77.0, 30.0
PERIODS = {"f_o1": STRUCK_HZ, "f_r1": SHAFT_HZ}


def struck(times_s: FloatArray, *, width_s: float = 1e-3, lasting: bool = False) -> Contact:
    """Half sines of force of 100 N at `times_s`; `lasting`: on top of 50 N that never end."""
    t = np.arange(int(RATE * SECONDS)) / RATE
    force = np.zeros_like(t)
    for start in times_s:
        inside = (t >= start) & (t < start + width_s)
        force[inside] += 100.0 * np.sin(np.pi * (t[inside] - start) / width_s)
    touching = np.ones_like(t) if lasting else (force > 0).astype(np.float64)
    return Contact(
        name="bearing1.wall",
        site="bearing1",
        touching=touching,
        force_n=force + 50.0 * lasting,
        periods_hz=PERIODS,
    )


REGULAR = np.arange(1.25, STRUCK_HZ * SECONDS) / STRUCK_HZ


def found(contact: Contact, start_s: float = 0.0) -> ContactImpacts:
    return find_impacts(contact, sampling_rate_hz=RATE, start_s=start_s, shafts_hz={"f_r1": SHAFT_HZ})


def test_impacts_after_flight_are_counted_with_touch_and_release() -> None:
    result = found(struck(REGULAR))
    n = REGULAR.size
    assert dict(result.counts) == {"touch": n, "release": n, "impact": n, "surge": 0}
    assert result.largest_force_n == pytest.approx(100.0, rel=1e-2)
    assert result.contact_share == pytest.approx(n * 1e-3 / SECONDS, rel=0.05)
    times = [e.time_s for e in result.events if e.kind == "impact"]
    assert times == pytest.approx(REGULAR + 0.5e-3, abs=1.5 / RATE)


def test_they_keep_time_with_their_period_and_with_no_other() -> None:
    folds = {f.base: f for f in found(struck(REGULAR)).folds}
    own = folds["f_o1"]
    assert own.per_period == pytest.approx(1.0, abs=0.02)
    assert own.coherence > 0.99 and own.locked
    assert own.mean_phase == pytest.approx(0.25 + 0.5e-3 * STRUCK_HZ, abs=0.01)
    assert sum(own.counts) == REGULAR.size and max(own.counts) > 0.9 * REGULAR.size
    assert folds["f_r1"].coherence < 0.1 and not folds["f_r1"].locked


def test_presses_on_a_lasting_contact_are_surges() -> None:
    result = found(struck(REGULAR, lasting=True))
    assert dict(result.counts) == {"touch": 0, "release": 0, "impact": 0, "surge": REGULAR.size}


def test_angles_and_times_count_from_zero() -> None:
    late = found(struck(REGULAR), start_s=0.5)
    first = next(e for e in late.events if e.kind == "impact")
    assert first.time_s == pytest.approx(0.5 + REGULAR[0] + 0.5e-3, abs=1.5 / RATE)
    assert first.angle_deg["f_r1"] == pytest.approx((360 * SHAFT_HZ * first.time_s) % 360)


def test_random_times_are_not_locked() -> None:
    times = np.sort(np.random.default_rng(1).uniform(0, SECONDS, 300))
    assert not fold(times, np.ones(300), "f_o1", STRUCK_HZ, SECONDS).locked


@pytest.mark.slow
def test_silence_has_no_events_and_the_list_is_bounded() -> None:
    quiet = found(struck(np.zeros(0)))
    assert sum(quiet.counts.values()) == 0 and quiet.events == () and quiet.folds[0].chance == 1.0
    busy = found(struck(np.arange(5, 1990) * 1e-3, width_s=4e-4))
    assert len(busy.events) == 1000
    assert busy.truncated == sum(busy.counts.values()) - 1000 > 4000


def test_forces_tell_where_in_the_period_they_are_large() -> None:
    phases = np.tile([0.1, 0.6], 50)
    times = (np.repeat(np.arange(50), 2) + phases) / STRUCK_HZ
    result = fold(times, np.tile([5.0, 20.0], 50), "f_o1", STRUCK_HZ, 50 / STRUCK_HZ, bins=10)
    assert result.mean_force_n[1] == pytest.approx(5.0) and result.mean_force_n[6] == pytest.approx(20.0)
    assert result.mean_force_n[3] is None and result.per_period == pytest.approx(2.0)
