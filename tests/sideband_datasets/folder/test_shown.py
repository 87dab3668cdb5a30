"""A folder of siblings whose faults partly do not show."""

from __future__ import annotations

import json

import pytest

from sideband_datasets.folder import Settings, make, verify
from sideband_datasets.folder.layout import CARD, FAILURES, MANIFEST
from tests.sideband_datasets.beside import siblings


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("shown") / "tiny"
    make(siblings(shown_db=0.0), out, Settings(shard_recordings=5), lambda progress: None)
    return out


@pytest.mark.slow
def test_what_is_left_out_is_listed_and_counted(folder):
    failures = [json.loads(line) for line in (folder / FAILURES).read_text().splitlines()]
    assert failures and {failure["kind"] for failure in failures} == {"NotShown"}
    document = json.loads((folder / MANIFEST).read_text())
    assert document["rows"] == 48 - 4 * len(failures)
    assert document["classes"]["healthy"] == 16
    assert "do not show their fault" in (folder / CARD).read_text()


@pytest.mark.slow
def test_it_verifies_and_its_rows_are_made_again(folder):
    assert not list(verify(folder, remake=4))
