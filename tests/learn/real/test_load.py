import numpy as np
import pytest

from learn.real.load import RECORDINGS, available, case, index, label

needed = pytest.mark.skipif(not available(), reason=f"the measured recordings are not at {RECORDINGS}")


@pytest.mark.parametrize(
    ("condition", "name"),
    [
        ("healthy (first hour of a 34-day run to failure)", "healthy"),
        ("outer-race fault", "outer"),
        ("inner-race fault", "inner"),
        ("ball fault", "ball"),
        ("bearing fault", "other"),
    ],
)
def test_conditions_are_classes(condition, name):
    assert label(condition) == name


@needed
@pytest.mark.parametrize("rig", ["cwru", "uestc", "hit_sm_mfs", "ims_healthy", "motor_acoustic"])
def test_recordings_are_read_as_the_catalogue_says(rig):
    entry = next(e for e in index() if e["dataset"] == rig)
    found = case(entry)
    assert np.all(np.isfinite(found.channels))
    assert found.rate_hz == entry["fs_hz"]
    if rig != "motor_acoustic":
        assert found.channels.shape[1] == entry["n_samples"]
    assert found.stated_hz == pytest.approx(found.speed_hz, rel=0.07)
