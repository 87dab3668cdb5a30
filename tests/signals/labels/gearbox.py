"""The seed paper's gearbox as labels see it, and synthetic signals for it."""

import numpy as np

from signals.labels import BearingKinematics, Kinematics, MeshKinematics, ShaftKinematics, kinematic_lines, label_peaks
from signals.labels.types import LabelSet
from signals.series import Series
from signals.spectra import amplitude_spectrum

PINION_TEETH, GEAR_TEETH, INPUT_HZ = 23, 81, 30.0
RATIO, BALLS = 0.2647, 7
RATE = 10_000.0


def bearing_hz(index: int, shaft_hz: float, balls: int = BALLS, ratio: float = RATIO) -> dict[str, float]:
    """Base frequencies of a bearing with contact angle 0."""
    cage = shaft_hz / 2 * (1 - ratio)
    return {
        f"f_c{index}": cage,
        f"f_o{index}": balls * cage,
        f"f_i{index}": balls * (shaft_hz - cage),
        f"f_b{index}": shaft_hz / (2 * ratio) * (1 - ratio**2),
    }


OUTPUT_HZ = INPUT_HZ * PINION_TEETH / GEAR_TEETH
BASES = {
    "f_r1": INPUT_HZ,
    "f_r2": OUTPUT_HZ,
    "f_m": PINION_TEETH * INPUT_HZ,
    **bearing_hz(1, INPUT_HZ),
    **bearing_hz(2, INPUT_HZ),
    **bearing_hz(3, OUTPUT_HZ),
    **bearing_hz(4, OUTPUT_HZ),
}
KINEMATICS = Kinematics(
    shafts=(ShaftKinematics(base="f_r1", component="input"), ShaftKinematics(base="f_r2", component="output")),
    meshes=(
        MeshKinematics(
            base="f_m",
            pinion_shaft="f_r1",
            pinion_teeth=PINION_TEETH,
            gear_shaft="f_r2",
            gear_teeth=GEAR_TEETH,
        ),
    ),
    bearings=tuple(
        BearingKinematics(index=i, shaft=shaft, balls=BALLS, diameter_ratio=RATIO, ball_order=1.756)
        for i, shaft in ((1, "f_r1"), (2, "f_r1"), (3, "f_r2"), (4, "f_r2"))
    ),
)
LINES = kinematic_lines(KINEMATICS, BASES, max_frequency_hz=RATE / 2)


def sines(lines: dict[float, float], seconds: float = 2.0, noise: float = 1e-3, seed: int = 0) -> Series:
    """Sines {frequency: amplitude} in white noise."""
    t = np.arange(int(RATE * seconds)) / RATE
    rng = np.random.default_rng(seed)
    samples = noise * rng.standard_normal(t.size)
    for frequency, amplitude in lines.items():
        samples += amplitude * np.sin(2 * np.pi * frequency * t + rng.uniform(0, 2 * np.pi))
    return Series(samples=samples, sampling_rate_hz=RATE, unit="m/s^2", name="r1")


def labelled(lines: dict[float, float], **options: object) -> LabelSet:
    """Labels of the gearbox for a signal of sines."""
    seconds = options.pop("seconds", 2.0)
    noise = options.pop("noise", 1e-3)
    spectrum = amplitude_spectrum(sines(lines, seconds=seconds, noise=noise))  # type: ignore[arg-type]
    return label_peaks(spectrum, LINES, BASES, kinematics=KINEMATICS, **options)  # type: ignore[arg-type]
