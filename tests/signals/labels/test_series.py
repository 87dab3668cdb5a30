"""Series of bearing defects far beyond the families' bound, in synthetic signals."""

import numpy as np
import pytest
from gearbox import BASES, KINEMATICS, RATE, sines

from signals.labels import Kinematics, ShaftKinematics, kinematic_lines, label_peaks
from signals.labels.canonical import HEALTHY
from signals.labels.families import Bound
from signals.labels.kinematics import BearingKinematics
from signals.labels.series import series_grids
from signals.labels.types import LabelSet
from signals.spectra import amplitude_spectrum
from sim.assembly.assemble import BASE_TERMS
from sim.core.lines import Line

F_I1, F_R1, F_B1, F_C1, F_O1 = (BASES[base] for base in ("f_i1", "f_r1", "f_b1", "f_c1", "f_o1"))
# a bearing whose lines no mesh crosses
BEARING = Kinematics(
    shafts=(ShaftKinematics(base="f_r1", component="input"),),
    bearings=KINEMATICS.bearings[:2],
)
HZ = {base: hz for base, hz in BASES.items() if base[-1] in "12" and base not in ("f_r2", "f_m")}
OWN = kinematic_lines(BEARING, HZ, max_frequency_hz=RATE / 2)
STEP_HZ = 60_000.0


def told(site: str, mechanism: str, family: str, *sums: dict[str, int]) -> list[Line]:
    return [
        Line(orders=tuple((b, n) for b, n in s.items() if n), component=site, mechanism=mechanism, family=family)
        for s in sums
    ]


INNER = told("bearing2", "inner_spall", "inner", *({"f_i2": k, "f_r1": n} for k in range(1, 9) for n in range(-2, 3)))
BALL = told("bearing1", "ball_spall", "ball", *({"f_b1": 2 * k, "f_c1": n} for k in range(1, 9) for n in range(-2, 3)))
BALLS = [
    line
    for i in (1, 2)
    for line in told(f"bearing{i}", "ball_contact", "outer", *({f"f_o{i}": k} for k in range(1, 7)))
]


def ringing(carrier_hz: float, side_hz: float, top_hz: float = 4800.0) -> dict[float, float]:
    """A series with a resonance at 3 kHz: its strong lines are those of high order."""
    found = {}
    for k in range(1, int(top_hz / carrier_hz)):
        for n in range(-3, 4):
            hz = k * carrier_hz + n * side_hz
            found[hz] = 0.5 ** abs(n) / (1 + ((hz - 3000.0) / 500.0) ** 2)
    return found


def labels(lines: dict[float, float], terms: list[Line], step_hz: float | None = None, **more: float) -> LabelSet:
    spectrum = amplitude_spectrum(sines(lines, seconds=4.0, noise=more.get("noise", 1e-4)))
    return label_peaks(spectrum, [*OWN, *terms], HZ, kinematics=BEARING, step_hz=step_hz)


@pytest.mark.slow
def test_an_inner_spall_is_followed_to_the_end_of_the_spectrum() -> None:
    found = labels(ringing(F_I1, F_R1), [*BALLS, *INNER], STEP_HZ)
    assert found.unexplained == 0
    for k in range(1, int(4800 / F_I1)):
        for n in range(-3, 4):
            label = f"{k}*f_i1" + (f"{n:+d}*f_r1" if n else "")
            peak = next((p for p in found.peaks if label in (p.label, *p.aliases)), None)
            peak = peak or found[label.replace("f_i1", "f_i2")]
            assert (peak.status, peak.mechanism, peak.component) == ("present", "inner_spall", "bearing2"), label
            assert peak.evidence == "term" if k <= 8 and abs(n) <= 2 else peak.evidence in ("family", "sum")
    assert not [p for p in found.peaks if p.family == "numerical"]


@pytest.mark.slow
def test_a_ball_spall_is_followed_with_the_cage() -> None:
    found = labels(ringing(2 * F_B1, F_C1), [*BALLS, *BALL])
    there = [p for p in found.with_status("present") if p.mechanism == "ball_spall"]
    assert len(there) > 0.95 * len(ringing(2 * F_B1, F_C1))
    peak = found["52*f_b1-1*f_c1"]
    assert (peak.status, peak.family, peak.component, peak.evidence) == ("present", "ball", "bearing1", "family")


def test_a_measured_series_goes_on_where_its_family_was_found() -> None:
    # a resonance low enough to show the first multiples too
    lines = {k * F_I1 + n * F_R1: 0.3 ** abs(n) / k**0.5 for k in range(1, 26) for n in range(-1, 2)}
    found = labels(lines, [])
    peak = found["25*f_i1+1*f_r1"]
    assert (peak.status, peak.family, peak.mechanism, peak.evidence) == ("present", "inner", "kinematic", "family")
    assert peak.component is None and peak.components == ("bearing1", "bearing2")


@pytest.mark.slow
def test_a_few_strangers_are_no_series() -> None:
    places = np.random.default_rng(5).uniform(1500.0, 4800.0, 200)
    found = labels({float(f): 0.01 for f in places}, [*BALLS, *INNER])
    assert len([p for p in found.with_status("present") if p.family == "inner"]) <= 2
    assert not [p for p in labels({float(f): 0.01 for f in places}, []).with_status("present") if p.family == "inner"]


def test_strong_lines_are_never_images_of_the_steps() -> None:
    lines = {k * F_O1: 1.0 / k for k in range(1, 20)}
    images = {abs(k * F_O1 - STEP_HZ): 0.2 for k in range(770, 785)}
    found = labels(lines | images, BALLS, STEP_HZ)
    assert not [p for p in found.peaks if p.family == "numerical"]
    weak = labels(lines | dict.fromkeys(images, 0.01), BALLS, STEP_HZ)
    assert len([p for p in weak.with_status("present") if p.family == "numerical"]) == len(images)


def test_images_without_evidence_get_no_name() -> None:
    found = labels({k * F_O1: 1.0 / k for k in range(1, 20)} | {abs(775 * F_O1 - STEP_HZ): 0.01}, BALLS, STEP_HZ)
    assert not [p for p in found.peaks if p.family == "numerical"] and found.unexplained == 1


def test_a_defect_names_the_line_before_the_healthy_balls() -> None:
    spall = told("bearing2", "outer_spall", "outer", *({"f_o2": k} for k in range(1, 9)))
    found = labels({k * F_O1: 1.0 / k for k in range(1, 40)}, [*BALLS, *spall])
    for label in ("1*f_o1", "7*f_o1", "15*f_o1", "39*f_o1"):
        peak = found[label]
        assert (peak.mechanism, peak.mechanism_basis, peak.component) == ("outer_spall", "predicted", "bearing2"), label
        assert peak.mechanisms == ("outer_spall", "ball_contact") and set(peak.components) == {"bearing1", "bearing2"}
    plain = labels({k * F_O1: 1.0 / k for k in range(1, 40)}, BALLS)["7*f_o1"]
    assert (plain.mechanism, plain.component) == ("ball_contact", None)


def test_every_effect_of_a_healthy_bearing_is_known() -> None:
    assert set(BASE_TERMS["bearing"]) == HEALTHY


def test_grids_hold_every_sum_once_and_even_ball_multiples_only() -> None:
    bound = Bound(series_shaft_sidebands=2, series_cage_sidebands=1)
    inner, ball = series_grids(BEARING, HZ, [*INNER, *BALL], found=(), top_hz=2000.0, bound=bound)
    assert (inner.family, ball.family) == ("inner", "ball")
    assert set(np.unique(ball.orders[:, 0] % 2)) == {0} and np.abs(ball.orders[:, 1]).max() == 1
    expected = {(k, n) for k in range(1, 60) for n in range(-2, 3) if 0 < k * F_I1 + n * F_R1 <= 2000.0}
    assert {(int(k), int(n)) for k, n in inner.orders} == expected
    assert inner.frequency_hz == pytest.approx(inner.orders @ np.array([F_I1, F_R1]))


def test_a_bearing_at_rest_has_no_series() -> None:
    lone = Kinematics(bearings=(BearingKinematics(index=1, shaft="f_r9", balls=7, diameter_ratio=0.26),))
    assert list(series_grids(lone, {}, INNER, found=("f_i1",), top_hz=2000.0, bound=Bound())) == []
