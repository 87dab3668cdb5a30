"""`dataset upload`: exit codes and what is told; what goes into the bucket is tested where it is done."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from app.cli import dataset_upload
from sideband_datasets.folder import verify
from tests.service.buckets import bucket_server, raw_client
from tests.sideband_datasets.small import document

Call = Callable[..., tuple[int, str, str]]


@pytest.fixture(scope="module")
def endpoint() -> Iterator[str]:
    with bucket_server("uploads") as opened:
        yield opened


@pytest.mark.slow
def test_a_dataset_made_here_comes_back_sound(
    call: Call, tmp_path: Path, endpoint: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    recipe, out, url = tmp_path / "recipe.json", tmp_path / "rig", f"s3://uploads/rig?endpoint={endpoint}"
    recipe.write_text(json.dumps(document(count=4, peaks={"spectra": []})))
    assert call("dataset", "make", recipe, "--out", out, "--workers", "1")[0] == 0
    raw, shown = raw_client(endpoint), dataset_upload.show

    def interrupt(bar: object, progress: object) -> None:
        shown(bar, progress)
        if progress.done:
            raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(dataset_upload, "show", interrupt)
        code, _, error = call("dataset", "upload", out, url)
    assert code == 130 and "to go on: the same command again" in error
    assert "rig/manifest.json" not in [e["Key"] for e in raw.list_objects_v2(Bucket="uploads").get("Contents", ())]
    code, told, error = call("dataset", "upload", out, url)
    assert code == 0 and "sent" in told and not error
    back = tmp_path / "back"
    for entry in raw.list_objects_v2(Bucket="uploads")["Contents"]:
        path = back / entry["Key"]
        path.parent.mkdir(parents=True, exist_ok=True)
        raw.download_file("uploads", entry["Key"], str(path))
    assert verify(back / "rig") == []
    assert "nothing to do" in call("dataset", "upload", out, url)[1]
    next((out / "data").iterdir()).unlink()
    code, _, error = call("dataset", "upload", out, url)
    assert code == 2 and error.startswith("error: DIR: is damaged: data/") and error.count("\n") == 1
    code, _, error = call("dataset", "upload", back / "rig", f"s3://nobodys/rig?endpoint={endpoint}")
    assert code == 2 and "error: URL: names a bucket that is not there" in error and error.count("\n") == 1


def test_wrong_input_is_told_by_its_field(call: Call, tmp_path: Path) -> None:
    for url, told in (("rig", "URL: is not of a bucket"), ("s3://bucket/rig?key=x", "URL: has an option"),
                      ("s3://bucket/rig", "DIR: has no manifest.json")):  # fmt: skip
        code, _, error = call("dataset", "upload", tmp_path, url)
        assert code == 2 and told in error and error.count("\n") == 1, url
