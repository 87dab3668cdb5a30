import numpy as np
import pytest

from learn import features, geometries, unknown, whole
from learn.sim2real.left_out import accuracy, doubts
from learn.sim2real.table import WINDOWS, Example
from sideband_datasets.recipe.bearings import CLASSES


def example(machine, k, rng):
    """A recording whose class shifts every feature but one of the pieces, which are noise."""
    shift = 3.0 * np.eye(4)[k]
    pieces = WINDOWS + 1

    def row(names, count=1):
        values = rng.standard_normal((count, len(names)))
        values[:, :4] += shift
        return values

    return Example(
        label=CLASSES[k],
        machine=machine,
        known=list(rng.standard_normal((pieces, len(features.NAMES)))),
        unknown=list(row(unknown.NAMES, pieces)),
        long=row(whole.NAMES),
        anywhere=row(unknown.NAMES),
        tried=rng.standard_normal((1, len(geometries.usual()), len(whole.NAMES))),
    )


@pytest.mark.slow
def test_machines_left_out_tell_features_that_say_something_from_those_that_do_not():
    rng = np.random.default_rng(0)
    text = accuracy([example(m, k, rng) for m in range(16) for k in range(4)], seed=0)
    assert "64 recordings of 16 machines" in text
    found = {line.split("|")[1].strip(): float(line.split("|")[2]) for line in text.splitlines()[4:]}
    assert found["geometry known, whole"] > 0.85
    assert found["geometry unknown, whole"] > 0.7
    assert found["geometry known, stretches"] < 0.6


def test_doubt_is_held_against_the_error_found():
    told = [(0.002, 0.003, 0.02), (0.004, -0.003, -0.02), (0.012, 0.01, 0.0)]
    rows = doubts(told).splitlines()[2:]
    assert rows == ["| 0 to 0.5 | 2 | 0.30 | 2.00 |", "| 1 to 1.8 | 1 | 1.00 | 0.00 |"]
