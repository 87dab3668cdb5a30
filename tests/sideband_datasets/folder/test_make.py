from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import psutil
import pytest

from sideband_datasets import rows
from sideband_datasets.folder import Settings, make, resume, unfinished, verify
from sideband_datasets.folder.shards import shards_of
from sideband_datasets.formats import FORMATS, fingerprint, record_of
from sideband_datasets.make import batch
from sideband_datasets.plan import make_plan
from sideband_datasets.recipe.read import document_of
from sim.core.errors import Diverged, SpecError
from tests.sideband_datasets.folder.conftest import RECIPE
from tests.sideband_datasets.small import tiny

pytestmark = pytest.mark.xdist_group("dataset-folder")

ROOT = Path(__file__).parents[3]


def _silent(progress: object) -> None:
    pass


def contents(out: Path) -> dict[str, bytes]:
    return {p.relative_to(out).as_posix(): p.read_bytes() for p in sorted(out.rglob("*")) if p.is_file()}


def written(path: Path) -> tuple[int, int]:
    """What a file keeps through renaming its folder, and loses when it is written again."""
    about = path.stat()
    return about.st_ino, about.st_mtime_ns


@pytest.mark.slow
def test_the_folder_holds_every_row_of_the_recipe(made):
    found = [r for path in sorted((made / "data").iterdir()) for r in FORMATS["parquet"].read(path)]
    expected = {row.row: fingerprint(record_of(row)) for row in rows(RECIPE)}
    assert {r["row"]: fingerprint(r) for r in found} == expected
    manifest = json.loads((made / "manifest.json").read_text())
    assert manifest["rows"] == 48
    assert manifest["splits"]["train"] == {"machines": 2, "recordings": 6, "rows": 24}
    assert sum(manifest["classes"].values()) == 48
    doubted = Counter(r["fault_type"] for r in found if len(r["warnings"]))
    assert doubted and manifest["doubted_rows"] == doubted
    assert all(f"{count} of {name}" in (made / "README.md").read_text() for name, count in doubted.items())


@pytest.mark.slow
def test_a_wrong_count_of_doubted_rows_is_found(copy):
    path = copy / "manifest.json"
    document = json.loads(path.read_text())
    path.write_text(json.dumps({**document, "doubted_rows": {}}))
    assert any("doubted_rows is {}" in finding.what for finding in verify(copy))


def test_shards_hold_every_recording_once_and_one_split_each():
    plan = make_plan(RECIPE)
    shards = shards_of(plan, ".parquet", 4)
    assert sorted(i for shard in shards for i in shard.recordings) == list(range(12))
    assert all(plan.split(i) == shard.split for shard in shards for i in shard.recordings)


@pytest.mark.slow
def test_an_interrupted_dataset_is_not_there_and_resumes_to_the_same_bytes(made, tmp_path, monkeypatch):
    out = tmp_path / "set"

    def interrupt(progress):
        if progress.rows >= 20:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        make(RECIPE, out, Settings(shard_recordings=2), interrupt)
    assert not out.exists()
    folder = unfinished(out)
    shards = [f"data/test-{k:05d}-of-00003.parquet" for k in range(2)]
    before = [written(folder / shard) for shard in shards]
    # half of a shard, a shard whose bytes went wrong
    (folder / "data" / ".test-00002-of-00003.parquet.1").write_bytes(b"half")
    (folder / shards[1]).write_bytes(b"x")
    resume(out, 1, _silent)
    assert contents(out) == contents(made)
    assert not folder.exists()
    after = [written(out / shard) for shard in shards]
    assert after[0] == before[0], "a finished shard is not made again"
    assert after[1] != before[1], "a spoiled one is"
    assert resume(out, 1, _silent)["rows"] == 48


@pytest.mark.slow
def test_shards_of_another_recipe_are_no_part_of_what_is_resumed(tmp_path):
    out, recipe = tmp_path / "set", tiny(count=6)

    def interrupt(progress):
        if progress.rows:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        make(recipe, out, Settings(shard_recordings=2), interrupt)
    with pytest.raises(SpecError, match=rf"was begun already as {recipe.name} \(seed {recipe.seed}, 6 recordings"):
        make(tiny(count=6, seed=77), out, Settings(), _silent)
    settings = unfinished(out) / "state" / "make.json"
    document = json.loads(settings.read_text())
    document["recipe"]["seed"] = 77
    settings.write_text(json.dumps(document))
    assert resume(out, 1, _silent)["recipe"]["seed"] == 77
    assert verify(out) == []


@pytest.mark.slow
def test_a_finished_folder_that_only_lacks_its_name_gets_it(made, tmp_path):
    out = tmp_path / "set"
    for name, content in contents(made).items():
        (unfinished(out) / name).parent.mkdir(parents=True, exist_ok=True)
        (unfinished(out) / name).write_bytes(content)
    resume(out, 1, _silent)
    assert contents(out) == contents(made)


def test_what_is_there_is_not_overwritten(made, tmp_path):
    with pytest.raises(SpecError, match="is there already"):
        make(RECIPE, made, Settings(), _silent)
    out = tmp_path / "set"
    (unfinished(out) / "state").mkdir(parents=True)
    begun = {"recipe": document_of(RECIPE), "format": "parquet", "shard_recordings": None, "versions": {"physics": "0"}}
    (unfinished(out) / "state" / "make.json").write_text(json.dumps(begun))
    with pytest.raises(SpecError, match="was begun already"):
        make(RECIPE, out, Settings(), _silent)
    with pytest.raises(SpecError, match="other versions"):
        resume(out, 1, _silent)
    with pytest.raises(SpecError, match="holds no dataset"):
        resume(tmp_path / "nothing", 1, _silent)


@pytest.mark.parametrize("text", ["", "{}", "[]", "null", '{"versions": 1}', "{"])
def test_damaged_settings_are_refused_with_their_place(text, tmp_path):
    out = tmp_path / "set"
    (unfinished(out) / "state").mkdir(parents=True)
    (unfinished(out) / "state" / "make.json").write_text(text)
    with pytest.raises(SpecError, match=r"set\.partial/state/make\.json: is damaged"):
        resume(out, 1, _silent)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["hdf5", "zarr", "webdataset", "npz"])
def test_every_format_makes_a_sound_folder(kind, tmp_path):
    pytest.importorskip(FORMATS[kind].package or "numpy")
    recipe = tiny(count=4, peaks={"spectra": []})
    make(recipe, tmp_path / "set", Settings(format=kind), _silent)
    assert verify(tmp_path / "set", remake=2) == []
    shard = next(p for p in sorted((tmp_path / "set" / "data").rglob("*")) if p.is_file() and p.stat().st_size)
    content = bytearray(shard.read_bytes())
    content[-1] ^= 1
    shard.write_bytes(content)
    assert any("differs" in str(finding) for finding in verify(tmp_path / "set"))


@pytest.mark.slow
def test_failed_recordings_are_listed_with_their_reason(tmp_path, monkeypatch):
    solved = batch.simulate_many

    def broken(members, **settings):
        found = solved(members, **settings)
        return [Diverged(time_s=0.1, dof="disc.x", advice="none"), *found[1:]]

    monkeypatch.setattr(batch, "simulate_many", broken)
    manifest = make(tiny(count=6, peaks={"spectra": []}), tmp_path / "set", Settings(), _silent)
    lines = [json.loads(line) for line in (tmp_path / "set" / "failures.jsonl").read_text().splitlines()]
    assert lines
    assert all("diverged at t = 0.1" in line["reason"] and line["kind"] == "Diverged" for line in lines)
    assert manifest["rows"] + manifest["failed_rows"] == 24
    assert manifest["failed_recordings"] == len(lines)
    assert verify(tmp_path / "set") == []


def _wait(until, seconds=120.0):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = until()
        if found:
            return found
        time.sleep(0.05)
    raise TimeoutError


def _workers(process: psutil.Process) -> list[psutil.Process]:
    with contextlib.suppress(psutil.NoSuchProcess):
        return [c for c in process.children() if any("spawn_main" in part for part in c.cmdline())]
    return []


@pytest.mark.slow
def test_workers_that_are_done_leave_nothing_behind(tmp_path):
    """Zarr's compressor holds semaphores, which processes that are ended instead of ending leave to the system."""
    pytest.importorskip("zarr")
    (tmp_path / "recipe.json").write_text(json.dumps(document_of(tiny(count=4, peaks={"spectra": []}))))
    found = subprocess.run(
        [sys.executable, "-m", "app.cli.main", "dataset", "make", "recipe.json", "--out", "set", "--format", "zarr",
         "--workers", "2", "--shard-recordings", "2"],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert "leaked" not in found.stderr and "Warning" not in found.stderr


@pytest.mark.slow
def test_a_killed_worker_and_a_killed_command_cost_nothing_but_their_shards(made, tmp_path):
    (tmp_path / "recipe.json").write_text(json.dumps(document_of(RECIPE)))
    out = tmp_path / "set"
    command = [sys.executable, "-m", "app.cli.main", "dataset", "make", "recipe.json", "--out", "set"]
    process = subprocess.Popen(
        [*command, "--workers", "2", "--shard-recordings", "2"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE,
    )
    watched = psutil.Process(process.pid)
    receipts = unfinished(out) / "state"
    try:
        workers = _wait(lambda: found if len(found := _workers(watched)) == 2 else None)
        workers[0].send_signal(signal.SIGKILL)
        _wait(lambda: len(list(receipts.glob("t*-*.json"))) >= 1)
        orphans = _workers(watched)
    finally:
        process.kill()
        process.communicate()
    assert not out.exists()
    _, alive = psutil.wait_procs(orphans, timeout=20)
    assert not alive, "workers outlived their command"
    resume(out, 1, _silent)
    assert contents(out) == contents(made)
