"""Recordings to train on, from the folder of a dataset."""

from __future__ import annotations

import numpy as np
import pytest

from learn.dataset import rows_of
from learn.orders import from_geometry
from sideband_datasets.folder import Settings, make
from sim.core.errors import SpecError
from sim.parts.bearing.from_spec import geometry_from_spec
from sim.presets import preset
from tests.sideband_datasets.beside import siblings


def _nobody(progress: object) -> None:
    """Nobody watches."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("learn") / "tiny"
    make(siblings(), out, Settings(), _nobody)
    return out


@pytest.mark.slow
def test_rows_have_labels_samples_and_the_orders_of_the_drawing(folder):
    found = list(rows_of([folder]))
    assert len(found) == 48
    assert {row.label for row in found} == {"healthy", "outer", "ball"}
    assert found[0].orders == from_geometry(geometry_from_spec(preset("rotor").bearings[0]))
    assert all(row.samples.dtype == np.float64 and 25 <= row.speed_hz <= 40 for row in found)


@pytest.mark.slow
def test_machines_are_parted_and_two_folders_have_different_ones(folder):
    parts = [{row.machine for row in rows_of([folder, folder], part, 3)} for part in range(3)]
    assert sum(map(len, parts)) == len(set.union(*parts)) == 8


def test_a_folder_without_a_dataset_is_refused(tmp_path):
    with pytest.raises(SpecError, match="holds no"):
        list(rows_of([tmp_path]))
