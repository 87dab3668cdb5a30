"""`dataset`: exit codes, what is told, and that nothing half-made stands under the folder's name."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from app.cli import dataset
from app.cli.main import main
from sideband_datasets.folder import Progress
from sideband_datasets.recipe import RECIPES
from tests.sideband_datasets.small import document

Call = Callable[..., tuple[int, str, str]]


def _recipe(tmp_path: Path, name: str = "recipe.json", **changes: object) -> str:
    path = tmp_path / name
    path.write_text(json.dumps(document(count=4, peaks={"spectra": []}, **changes)))
    return str(path)


def test_recipes(call: Call) -> None:
    assert all(name in call("dataset", "recipes")[1] for name in RECIPES)
    assert json.loads(call("dataset", "recipes", "gearbox")[1])["name"] == "gearbox"
    code, _, told = call("dataset", "recipes", "gearbx")
    assert code == 2
    assert "did you mean gearbox" in told


@pytest.mark.slow
def test_plan(call: Call, tmp_path: Path) -> None:
    code, told, _ = call("dataset", "plan", _recipe(tmp_path), "--count", "8", "--json")
    answer = json.loads(told)
    assert code == 0
    assert answer["rows"] == 32
    assert answer["splits"] == {"train": 4, "test": 4}
    assert sum(answer["classes"].values()) == 8
    assert "core-seconds" in call("dataset", "plan", "bearing-rig")[1]


@pytest.mark.slow
def test_make_verify_and_card(call: Call, tmp_path: Path) -> None:
    out = tmp_path / "set"
    code, told, _ = call("dataset", "make", _recipe(tmp_path), "--out", str(out), "--workers", "1")
    assert code == 0
    assert "16 rows, 0 failed" in told
    assert call("dataset", "verify", str(out), "--remake", "2")[:2] == (0, f"{out}: nothing is wrong\n")
    assert call("dataset", "card", str(out))[1] == (out / "README.md").read_text()
    assert call("dataset", "resume", str(out))[0] == 0
    assert "is there already" in call("dataset", "make", _recipe(tmp_path), "--out", str(out))[2]
    next((out / "data").iterdir()).unlink()
    code, told, _ = call("dataset", "verify", str(out), "--json")
    assert code == 1
    assert json.loads(told)["findings"][0]["what"] == "is missing"


def test_wrong_input_is_told_by_its_field(call: Call, tmp_path: Path) -> None:
    for arguments, told in (
        (("plan", _recipe(tmp_path, "wrong.json", sedd=3)), "sedd: is not a known field"),
        (("plan", "nothing"), "unknown recipe"),
        (("plan", str(tmp_path / "no.json")), "no such file"),
        (("make", _recipe(tmp_path), "--out", str(tmp_path / "x"), "--format", "parqet"), "did you mean parquet"),
        (("make", _recipe(tmp_path), "--out", str(tmp_path / "x"), "--workers", "0"), "--workers"),
        (("verify", str(tmp_path)), "manifest.json"),
        (("resume", str(tmp_path / "x")), "holds no dataset"),
        (("card", str(tmp_path)), "no such file"),
    ):
        code, _, error = call("dataset", *arguments)
        assert code == 2, arguments
        assert told in error
    assert not list(tmp_path.glob("x*"))


def test_a_url_is_no_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for arguments in (
        ("dataset", "make", "small", "--out", "s3://bucket/x"),
        ("dataset", "resume", "s3://bucket/x"),
        ("machine", "--preset", "rotor", "--out", "https://host/machine.json"),
        ("simulate", "--preset", "rotor", "--out", "s3://bucket/x"),
    ):
        with pytest.raises(SystemExit) as ended:
            main(arguments)
        assert ended.value.code == 2, arguments
        error = capsys.readouterr().err
        assert "is a URL" in error and "sideband dataset upload" in error
    assert list(tmp_path.iterdir()) == []


def test_shards_beyond_the_bound_are_refused_and_little_space_is_told(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    windows = {"per_recording": 1000, "length_s": 1.15, "overlap": 0.95}
    large = _recipe(tmp_path, duration_s=60.0, sampling_rate_hz=50_000.0, windows=windows)
    for action in (("plan", large), ("make", large, "--out", str(tmp_path / "x"))):
        code, _, error = call("dataset", *action, "--count", "40", "--shard-recordings", "40")
        assert code == 2
        assert "--shard-recordings: makes shards of up to" in error and "2 recordings or fewer" in error
    monkeypatch.setattr(dataset, "free_bytes", lambda folder: 1000)
    code, told, _ = call("dataset", "plan", large)
    assert code == 0
    assert "warning: the disk of this folder has 1000 bytes free" in told
    assert not list(tmp_path.glob("x*"))


@pytest.mark.slow
def test_an_interruption_says_how_to_go_on(call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "set"
    shown = dataset._show

    def interrupt(bar: object, progress: Progress) -> None:
        shown(bar, progress)
        if progress.rows:
            raise KeyboardInterrupt

    monkeypatch.setattr(dataset, "_show", interrupt)
    making = ("dataset", "make", _recipe(tmp_path), "--out", str(out), "--workers", "1")
    code, _, error = call(*making)
    assert code == 130
    assert f"sideband dataset resume {out}" in error
    assert not out.exists()
    monkeypatch.undo()
    assert "was begun already" in call(*making)[2]
    assert "unfinished" in call("dataset", "verify", str(out))[2]
    assert call("dataset", "resume", str(out), "--workers", "1")[0] == 0
    assert call("dataset", "verify", str(out))[0] == 0
