"""Layouts of text files, and what is refused with its line."""

from __future__ import annotations

import gzip
import io
import time
import weakref
from pathlib import Path

import numpy as np
import pytest

from signals.ingest import Bounds
from signals.readers import text
from signals.readers.text import open_file as open_text
from sim.core.errors import SpecError

ROWS = 12


def columns(path: Path, bounds: Bounds | None = None) -> dict[str, list[float]]:
    with open_text(path, bounds or Bounds()) as contents:
        return {name: np.asarray(x).tolist() for name, x in contents.load(list(contents.entries)).items()}


def written(folder: Path, text: str, name: str = "r.csv") -> Path:
    (folder / name).write_bytes(text.encode())
    return folder / name


@pytest.mark.parametrize(
    ("head", "row", "names"),
    [
        ("a,b\n", "1.5,-2e3\n", ["a", "b"]),
        ('"a","b",\n', "1.5,-2e3,\n", ["a", "b", "column"]),
        ("", "1.5,-2e3\n", ["0", "1"]),
        ("", "1.5\t-2e3\n", ["0", "1"]),
        ("", " 1.5   -2e3\n", ["0", "1"]),
        ("a b\n", "1.5 -2e3\n", ["a", "b"]),
        ("a;b\n", "1,5;-2e3\n", ["a", "b"]),
        ("# rig 7\nserial 42\n\na,b\ng,m/s^2\n", "1.5,-2e3\n", ["a", "b"]),
        ("a [g],b [m/s^2]\n", "1.5,-2e3\r\n", ["a", "b"]),
        ("\ufeffa,b\n", "1.5,-2e3\n", ["a", "b"]),
        ("a,a\n", "1.5,-2e3\n", ["a", "a (1)"]),
    ],
)
def test_layouts(tmp_path, head: str, row: str, names: list[str]) -> None:
    found = columns(written(tmp_path, head + row * ROWS))
    assert [name.partition(" (2)")[0] for name in found] == names
    first, second = list(found.values())[:2]
    assert (first, second) == ([1.5] * ROWS, [-2000.0] * ROWS)


@pytest.mark.parametrize("text", ["a [g],b\n1,2\n", "a,b\ng,\n1,2\n"])
def test_units_of_the_file_are_seen(tmp_path, text: str) -> None:
    with open_text(written(tmp_path, text), Bounds()) as contents:
        assert [entry.unit for entry in contents.entries.values()] == ["g", ""]


def test_gzip_and_latin_letters(tmp_path) -> None:
    path = tmp_path / "r.csv.gz"
    path.write_bytes(gzip.compress("Köper [µm],b\n1,2\n".encode("latin-1")))
    assert columns(path) == {"Köper": [1.0], "b": [2.0]}


def test_an_empty_cell_is_a_missing_sample_and_at_the_end_the_end(tmp_path) -> None:
    found = columns(written(tmp_path, "a,b,c\n1,,5\n2,3,\nnan,4,\n"))
    np.testing.assert_array_equal(found["a"], [1, 2, np.nan])
    np.testing.assert_array_equal(found["b"], [np.nan, 3, 4])
    assert found["c"] == [5.0]


def test_a_column_that_is_not_asked_for_may_hold_anything(tmp_path) -> None:
    path = written(tmp_path, "a,b\n1,2\n3,later\n")
    with open_text(path, Bounds()) as contents:
        np.testing.assert_array_equal(contents.entries["a"].load(), [1, 3])
        with pytest.raises(SpecError, match="later"):
            contents.entries["b"].load()


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "no line of numbers"),
        ("a,b\n", "no line of numbers"),
        ("a,b\n1,2,3\n", "2 names in line 1, 3 columns below"),
        ("a,b\n1,x\n2,3\n", "line 2 holds a text"),
        ("a,b\n1,2\n3\n", "Expected 2 columns, got 1"),
        ("a,b\n1,2\n3,4,5\n", "Expected 2 columns, got 3"),
        ("1 2\n3 x\n", "x"),
        ("\0\0\0\1\xff", "no line of numbers"),
    ],
)
def test_what_is_broken_is_refused_with_its_place(tmp_path, text: str, reason: str) -> None:
    with pytest.raises(SpecError, match=reason) as caught:
        columns(written(tmp_path, text))
    assert caught.value.problems[0].field == "r.csv"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a,b\n" + "1,2\n" * 499 + "3,hello\n", "column b, line 501: invalid value 'hello'"),
        ("# made by hand\n\na,b\nm,s\n1,2\n\n\n3,hello\n", "column b, line 8: invalid value 'hello'"),
        ("1,2\n3,hello\n", "column 1, line 2: invalid value 'hello'"),
        ("a,b\n1,2\n\n3,4,5\n", "line 4: Expected 2 columns, got 3"),
    ],
)
def test_a_wrong_cell_is_told_by_its_column_and_its_line_of_the_file(tmp_path, text: str, said: str) -> None:
    with pytest.raises(SpecError) as caught:
        columns(written(tmp_path, text))
    assert caught.value.problems[0].message.startswith(f"cannot be read: {said}")


@pytest.mark.slow
def test_a_gzip_bomb_ends_at_the_bound(tmp_path) -> None:
    path = tmp_path / "bomb.csv.gz"
    path.write_bytes(gzip.compress(b"a\n" + b"0\n" * 4_000_000))
    assert path.stat().st_size < 20_000
    with pytest.raises(SpecError, match="once unpacked"):
        columns(path, Bounds(unpacked_bytes=1_000_000))
    with pytest.raises(SpecError, match="too many samples"):
        columns(path, Bounds(values=1_000_000))


@pytest.mark.parametrize("cut", [10, 200])
def test_a_cut_gzip_is_refused(tmp_path, cut: int) -> None:
    path = tmp_path / "r.csv.gz"
    whole = gzip.compress(b"a,b\n" + b"".join(f"{i},{i**2}\n".encode() for i in range(2000)))
    path.write_bytes(whole[:-cut])
    with pytest.raises(SpecError, match="cannot be read"):
        columns(path)


def test_blanks_are_bounded_too(tmp_path) -> None:
    with pytest.raises(SpecError, match="too many samples"):
        columns(written(tmp_path, "1 2\n" * 100), Bounds(values=100))


@pytest.mark.parametrize("word", ["0.5", "oops"])
def test_no_thread_reads_on_when_the_file_is_done(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, word: str) -> None:
    """A thread of Arrow's that still reads when the interpreter ends aborts the process; it is waited for no longer."""
    opened: list[weakref.ref[io.BufferedReader]] = []
    waits: list[float] = []

    def noted(path: Path, bounds: Bounds) -> io.BufferedReader:
        stream = opener(path, bounds)
        opened.append(weakref.ref(stream))
        return stream

    def waited(seconds: float) -> None:
        waits.append(seconds)
        sleep(seconds)

    opener, sleep = text._stream, time.sleep
    monkeypatch.setattr(text, "_stream", noted)
    monkeypatch.setattr(text.time, "sleep", waited)
    rows = [f"{i},1.0" for i in range(400_000)]
    rows[200_000] = f"{word},1.0"
    path = written(tmp_path, "a,b\n" + "\n".join(rows) + "\n")
    if word == "oops":
        with pytest.raises(SpecError, match="cannot be read"):
            columns(path)
    else:
        assert len(columns(path)["a"]) == len(rows)
    assert opened and all(one() is None for one in opened)
    assert len(waits) < text.RELEASE_TRIES


@pytest.mark.parametrize(
    ("ending", "said"),
    [("1.25,2.25\n", False), ("1.25,2.25", False), ("1.25,2.2", True), ("1.25,2", True), ("1.25,-2.25", False)],
)
@pytest.mark.parametrize("delimiter", [",", " "])
def test_a_last_number_that_is_cut_short_is_remarked_on(tmp_path, ending: str, said: bool, delimiter: str) -> None:
    path = tmp_path / "r.csv"
    path.write_text(("a,b\n" + "1.25,2.25\n" * 30 + ending).replace(",", delimiter))
    with open_text(path, Bounds()) as contents:
        assert bool(contents.remarks) == said
