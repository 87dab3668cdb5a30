"""A finished folder takes its name: checked, alone, and after a kill at any moment."""

from __future__ import annotations

import json
import os
import shutil
import sys
from pathlib import Path

import pytest

from sideband_datasets.folder import Settings, make, resume, unfinished, verify
from sideband_datasets.folder.layout import files_below
from sideband_datasets.folder.publish import alone
from sim.core.errors import SpecError
from tests.sideband_datasets.folder.conftest import RECIPE

pytestmark = pytest.mark.xdist_group("dataset-folder")

CHANGES = ("replace", "unlink", "rmdir", "mkdir", "fsync")
"""Of a disk: what a kill may come before. Files are written under names of their own until one of these."""


class Killed(BaseException):
    """No clean-up of a killed process does anything."""


def silent(progress):
    pass


def contents(out):
    return {path.relative_to(out).as_posix(): path.read_bytes() for path in files_below(out)}


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """All that a command had written when it was killed before it published: six shards, their receipts, the rest."""
    out = tmp_path_factory.mktemp("written") / "set"
    with pytest.MonkeyPatch.context() as patch, pytest.raises(Killed):
        # By its name: the package has a function called as the module.
        patch.setattr(sys.modules["sideband_datasets.folder.make"], "publish", _killed)
        make(RECIPE, out, Settings(shard_recordings=2), silent)
    assert (unfinished(out) / "state" / "make.json").is_file() and (unfinished(out) / "manifest.json").is_file()
    return unfinished(out)


def _killed(*_):
    raise Killed


@pytest.fixture
def out(written, tmp_path):
    """Where the dataset shall be; a copy of `written` is beside it."""
    shutil.copytree(written, unfinished(tmp_path / "set"))
    return tmp_path / "set"


def stateless(out: Path) -> Path:
    shutil.rmtree(unfinished(out) / "state")
    return unfinished(out)


@pytest.mark.slow
def test_a_kill_at_any_moment_leaves_what_resume_finishes(written, made, tmp_path):
    moments = 0
    for moment in range(200):
        out = tmp_path / str(moment) / "set"
        folder = shutil.copytree(written, unfinished(out))
        for name in ("manifest.json", "README.md"):
            (folder / name).unlink()
        if not _killed_at(moment, out):
            break
        moments += 1
        assert not out.exists() or verify(out) == [], "nobody reads half a dataset"
        if not out.exists():
            with pytest.raises(SpecError, match="was begun already"):
                make(RECIPE, out, Settings(), silent)
        resume(out, 1, silent)
        assert contents(out) == contents(made), moment
        assert [path.name for path in out.parent.iterdir()] == ["set"]
        shutil.rmtree(out.parent)
    assert 20 < moments < 199


def _killed_at(moment: int, out: Path) -> bool:
    """Whether the process that resumes was killed before its change number `moment` of the disk."""
    done = 0

    def dying(change):
        def changed(*arguments, **named):
            nonlocal done
            if done >= moment:
                raise Killed
            done += 1
            return change(*arguments, **named)

        return changed

    with pytest.MonkeyPatch.context() as patch:
        for name in CHANGES:
            patch.setattr(os, name, dying(getattr(os, name)))
        try:
            resume(out, 1, silent)
        except Killed:
            return True
    return False


@pytest.mark.slow
def test_what_lacks_a_shard_is_made_again_or_refused(out, made):
    shard = unfinished(out) / "data" / "train-00001-of-00003.parquet"
    shard.unlink()
    resume(out, 1, silent)
    assert contents(out) == contents(made)


@pytest.mark.parametrize("harm", ["removed", "changed", "surplus", "card", "no manifest"])
def test_damage_without_state_is_refused_with_its_place(out, harm):
    folder = stateless(out)
    place = {
        "surplus": "data/more.parquet",
        "card": "README.md",
        "no manifest": "manifest.json",
    }.get(harm, "data/train-00001-of-00003.parquet")
    if harm == "removed":
        (folder / place).unlink()
    else:
        (folder / place).write_bytes(b"x")
    before = contents(folder)
    with pytest.raises(SpecError, match="cannot be finished") as told:
        resume(out, 1, silent)
    assert place in str(told.value)
    assert contents(folder) == before and not out.exists()


@pytest.mark.slow
def test_a_file_of_somebody_else_is_neither_published_nor_removed(out, made):
    guest = unfinished(out) / "data" / "notes.txt"
    guest.write_text("mine")
    with pytest.raises(SpecError, match=r"no part of it: data/notes\.txt"):
        resume(out, 1, silent)
    assert guest.read_text() == "mine"
    guest.unlink()
    resume(out, 1, silent)
    assert contents(out) == contents(made)


@pytest.mark.slow
def test_hidden_leftovers_are_not_published(out, made):
    for name in (".manifest.json.1", "data/.test-00000-of-00003.parquet.1"):
        (unfinished(out) / name).write_text("half")
    stateless(out)
    resume(out, 1, silent)
    assert contents(out) == contents(made)


def test_make_refuses_what_was_begun_even_without_its_state(out):
    folder = stateless(out)
    before = contents(folder)
    other = RECIPE.model_copy(update={"seed": 77})
    with pytest.raises(SpecError, match="was begun already") as told:
        make(other, out, Settings(), silent)
    assert "sideband dataset resume" in str(told.value)
    assert contents(folder) == before and not out.exists()


@pytest.mark.slow
def test_the_manifest_of_another_recipe_is_not_believed(out, made):
    folder = unfinished(out)
    manifest = json.loads((folder / "manifest.json").read_text())
    begun = json.loads((folder / "state" / "make.json").read_text())
    begun["recipe"]["notes"] = "another"
    (folder / "state" / "make.json").write_text(json.dumps(begun))
    assert resume(out, 1, silent)["recipe"] == begun["recipe"] != manifest["recipe"]
    assert verify(out) == []


def test_one_command_at_a_time(out):
    folder = unfinished(out)
    with alone(folder), pytest.raises(SpecError, match="another command"):
        resume(out, 1, silent)
    with alone(folder):
        pass


def test_a_dataset_that_is_there_is_not_overwritten(out):
    out.mkdir()
    (out / "x").write_text("x")
    with pytest.raises(SpecError, match="is there already"):
        resume(out, 1, silent)
    assert unfinished(out).is_dir()
