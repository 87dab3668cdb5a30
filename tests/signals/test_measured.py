"""Measured recordings with known defects: the defect's line is found in the envelope, and labelled.

CWRU bearing data (Case Western Reserve University bearing data center), drive end 6205-2RS: 9 balls of 7.94 mm on
39.04 mm, contact angle 0.
"""

from pathlib import Path

import numpy as np
import pytest

from signals.labels import BearingKinematics, Bound, Kinematics, Matching, ShaftKinematics, kinematic_lines, label_peaks
from signals.labels.types import LabelSet
from signals.series import Series
from signals.spectra import envelope_spectrum

FOLDER = Path(__file__).parents[2].resolve().parent / "shared" / "recordings" / "cwru"
SHAFT_HZ, BALLS, RATIO = 29.933, 9, 7.94 / 39.04
CAGE_HZ = SHAFT_HZ / 2 * (1 - RATIO)
BASES = {
    "f_r1": SHAFT_HZ,
    "f_c1": CAGE_HZ,
    "f_o1": BALLS * CAGE_HZ,
    "f_i1": BALLS * (SHAFT_HZ - CAGE_HZ),
    "f_b1": SHAFT_HZ / (2 * RATIO) * (1 - RATIO**2),
}
KINEMATICS = Kinematics(
    shafts=(ShaftKinematics(base="f_r1", component="motor"),),
    bearings=(BearingKinematics(index=1, shaft="f_r1", balls=BALLS, diameter_ratio=RATIO, component="drive_end"),),
)


def labels(name: str) -> LabelSet:
    path = FOLDER / f"{name}.npz"
    if not path.exists():
        pytest.skip(f"the CWRU recording {name} is not beside this project")
    with np.load(path, allow_pickle=False) as file:
        series = Series(samples=file["DE"], sampling_rate_hz=float(file["fs_hz"]), unit="g", name="DE")
    spectrum = envelope_spectrum(series, min_bandwidth_hz=1000.0)
    lines = kinematic_lines(
        KINEMATICS, BASES, max_frequency_hz=800.0, bound=Bound(outer=5, inner=5, inner_shaft_sidebands=2)
    )
    return label_peaks(spectrum, lines, BASES, kinematics=KINEMATICS, matching=Matching(relative=0.005))


def level(found: LabelSet, label: str) -> float:
    """dB over the floor, 0 when absent."""
    return found[label].db_over_floor or 0.0


@pytest.mark.slow
def test_an_outer_race_fault_shows_its_family() -> None:
    found = labels("cwru_1797rpm_outerrace_007in_6oclock")
    assert all(level(found, f"{k}*f_o1") > 30 for k in (1, 2, 3))
    assert level(found, "1*f_o1") > level(found, "1*f_i1") + 20
    assert found.band is not None and found.band.impulsive


@pytest.mark.slow
def test_an_inner_race_fault_shows_its_family_with_shaft_sidebands() -> None:
    found = labels("cwru_1797rpm_innerrace_007in")
    assert level(found, "1*f_i1") > 30
    assert level(found, "1*f_i1-1*f_r1") > 20 and level(found, "1*f_i1+1*f_r1") > 20
    assert level(found, "1*f_i1") > level(found, "1*f_o1") + 20


def test_the_healthy_bearing_shows_no_such_line() -> None:
    found = labels("cwru_1797rpm_normal_first_half")
    assert level(found, "1*f_o1") < 25 and level(found, "1*f_i1") < 25
