"""A measured gearbox without a tacho: SpectraQuest rig of 32 teeth at about 30 Hz (OpenEI submission 623).

The sampling rate is not stated by the source; 12.8 kHz makes the mesh harmonics fit the stated speed.
"""

import gzip
from pathlib import Path

import numpy as np
import pytest

from signals.angle import tacholess_angle
from signals.series import Series
from signals.synchronous import SynchronousAverage, synchronous_average

FOLDER = Path(__file__).parents[3].resolve().parent / "shared" / "recordings" / "openei_gear"
TEETH, RATE = 32, 12_800.0


def record(name: str) -> Series:
    path = FOLDER / f"{name}.csv.gz"
    if not path.exists():
        pytest.skip(f"the recording {name} of the gearbox is not beside this project")
    with gzip.open(path, "rt") as file:
        samples = np.loadtxt(file, delimiter=",", skiprows=1, usecols=0)
    return Series(samples=samples, sampling_rate_hz=RATE, unit="1", name="a1")


def mesh(average: SynchronousAverage) -> float:
    return float(np.abs(np.fft.rfft(average.samples)[TEETH]) * 2 / average.samples_per_revolution)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "speed_hz"), [("h30hz0", 29.754), ("h30hz50", 29.676), ("b30hz80", 29.614)])
def test_the_speed_is_that_of_the_mesh_and_the_average_gains(name: str, speed_hz: float) -> None:
    """Speeds as stated with the recordings; the motor's slip varies, so a constant speed smears the mesh."""
    series = record(name)
    track = tacholess_angle(series, orders=(TEETH, 2 * TEETH), low_hz=28.8, high_hz=30.2)
    mean = float(np.mean(track.speed_hz[np.isfinite(track.angle_rad)]))
    assert mean == pytest.approx(speed_hz, rel=5e-4)
    assert track.spread_rad is not None and track.spread_rad < 0.02
    found = synchronous_average(series, shaft="input", rotation=track.angle_rad)
    constant = synchronous_average(series, shaft="input", rotation=mean)
    gain = mesh(found) / mesh(constant)
    assert gain > 1.0 and (name == "h30hz0" or gain > 1.2)
