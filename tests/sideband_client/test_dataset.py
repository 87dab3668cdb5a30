"""A dataset through the client: asked for, waited for, looked at, fetched, fetched again."""

from __future__ import annotations

from pathlib import Path

import pytest

from sideband_client import Client, Dataset, Progress, errors
from sideband_datasets.folder import verify
from tests.sideband_datasets.small import document

RECIPE = document(count=4, peaks={"spectra": []})


@pytest.mark.slow
def test_from_recipe_to_folder(client: Client, tmp_path: Path) -> None:
    assert "small" in {ready["name"] for ready in client.recipes()["recipes"]}
    assert client.estimate_dataset(RECIPE, format="npz")["rows"] == 16
    seen: list[Progress] = []
    job = client.make_dataset(RECIPE, format="npz")
    with pytest.raises(errors.NotReady):
        job.dataset()
    made = job.wait(progress=seen.append, timeout_s=120).dataset()
    assert any("shards" in told.stage for told in seen)
    assert made.manifest["rows"] == 16 and made.manifest["format"] == "npz"
    (row,) = made.rows(3, 1, signal=True, max_points=50)
    assert len(row["signal"]["values"]) <= 50 and row["columns"]["fault_origin"] == "simulated"
    told: list[tuple[int, int]] = []
    folder = made.download(tmp_path / "d", progress=lambda done, total: told.append((done, total)))
    assert verify(folder) == [] and told[-1][0] == told[-1][1]
    shard = next((folder / "data").iterdir())
    whole, before = shard.read_bytes(), (folder / "README.md").stat().st_mtime_ns
    shard.write_bytes(whole[:-7] + b"damaged")
    made.download(folder)
    assert shard.read_bytes() == whole and (folder / "README.md").stat().st_mtime_ns == before


def test_refusals_and_unknown_datasets(client: Client) -> None:
    with pytest.raises(errors.InvalidRequest) as told:
        client.make_dataset({**RECIPE, "cuont": 3})
    assert told.value.fields[0].field == "recipe.cuont"
    with pytest.raises(errors.NotFound):
        _ = client.dataset("nonesuch").files
    with pytest.raises(ValueError, match="not a name"):
        client.dataset("../jobs")


def test_a_path_out_of_the_folder_is_refused(client: Client, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    entry = {"path": "../outside", "bytes": 1, "sha256": "0"}
    monkeypatch.setattr(Dataset, "files", property(lambda self: [entry]))
    with pytest.raises(errors.BadReply, match="outside"):
        client.dataset("any").download(tmp_path / "d")
    assert list(tmp_path.iterdir()) == []
