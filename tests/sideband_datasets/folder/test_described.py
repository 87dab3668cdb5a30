from __future__ import annotations

import hashlib
import json

import pytest

from sideband_datasets import COLUMNS
from sideband_datasets.formats import FORMATS


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_croissant_holds_for_its_own_tool(made):
    mlcroissant = pytest.importorskip("mlcroissant")
    dataset = mlcroissant.Dataset(jsonld=str(made / "croissant.json"))
    assert not dataset.metadata.issues.errors
    found = list(dataset.records(record_set="rows"))
    assert len(found) == 48
    assert {"rows/signal", "rows/bpfo_hz", "rows/labels", "rows/peaks"} <= set(found[0])
    wanted = {r["row"]: r["peaks"] for p in sorted((made / "data").iterdir()) for r in FORMATS["parquet"].read(p)}
    for row in found:
        assert [p["rows/peaks/frequency_hz"] for p in row["rows/peaks"]] == pytest.approx(
            [p["frequency_hz"] for p in wanted[row["rows/row"]]]
        )
    assert any(wanted.values())


def test_croissant_has_the_checksum_of_every_shard(made):
    document = json.loads((made / "croissant.json").read_text())
    listed = {e["contentUrl"]: e["sha256"] for e in document["distribution"] if "contentUrl" in e}
    assert listed == {f"data/{p.name}": hashlib.sha256(p.read_bytes()).hexdigest() for p in (made / "data").iterdir()}


def test_the_card_says_what_was_done_and_what_was_not(made):
    card = (made / "README.md").read_text()
    for told in ("not modelled", "CC-BY-4.0", "Cite as", "outer-race spall", "25 to 40", "No machine and no transfer"):
        assert told in card
    assert all(f"| {column.name} |" in card for column in COLUMNS)
    assert all(p.name in card for p in (made / "data").iterdir())


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_the_hugging_face_loader_reads_the_folder(made, tmp_path, monkeypatch):
    monkeypatch.setenv("HF_DATASETS_OFFLINE", "1")
    datasets = pytest.importorskip("datasets")
    found = datasets.load_dataset(str(made), cache_dir=str(tmp_path))
    assert {name: part.num_rows for name, part in found.items()} == {"train": 24, "test": 24}
    assert found["train"].column_names == [c.name for c in COLUMNS]
    assert len(found["test"][0]["signal"]) == found["test"][0]["samples"]
    assert {p["spectrum"] for p in found["test"][0]["peaks"]} <= {"envelope"}
