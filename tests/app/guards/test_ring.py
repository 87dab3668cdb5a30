"""Keys from a file: strict, and read again while the server runs; a broken one changes nothing."""

from __future__ import annotations

import json
import logging
from pathlib import Path

import pytest

from app.guards.ring import LOOK_EVERY_S, KeyRing
from app.key_file import MAX_KEYS, Key, parse_key_file, read_keys
from sim.core.errors import SpecError

A, B, C = "a" * 64, "b" * 64, "c" * 64


class Time:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def write(path: Path, *entries: dict[str, object]) -> None:
    path.write_text(json.dumps({"keys": entries}), encoding="utf-8")


def test_rotation_without_a_restart(tmp_path: Path) -> None:
    file, clock = tmp_path / "keys.json", Time()
    write(file, {"name": "ann", "sha256": A})
    ring = KeyRing({C: "carl"}, file, clock=clock)
    assert ring.find(A) == Key(name="ann") and ring.find(C) == Key(name="carl") and ring.find(B) is None
    write(file, {"name": "ann", "sha256": A, "not_after": "1970-01-01T00:01:00+00:00"}, {"name": "ann", "sha256": B})
    assert ring.find(B) is None, "looked before its time"
    clock.now += LOOK_EVERY_S
    assert ring.find(A) == Key(name="ann", not_after=60.0) and ring.find(B) == Key(name="ann")
    write(file)
    clock.now += LOOK_EVERY_S
    assert ring.find(A) is None and ring.find(B) is None and ring.find(C) is not None


def test_a_broken_file_keeps_the_keys_and_is_logged_once(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    file, clock = tmp_path / "keys.json", Time()
    write(file, {"name": "ann", "sha256": A})
    ring = KeyRing({}, file, clock=clock)
    for broken in ('{"keys": [', None):
        caplog.clear()
        file.write_text(broken, encoding="utf-8") if broken else file.unlink()
        for _ in range(3):
            clock.now += LOOK_EVERY_S
            assert ring.find(A) == Key(name="ann")
        assert [r.levelno for r in caplog.records] == [logging.ERROR]
    write(file, {"name": "ben", "sha256": B})
    clock.now += LOOK_EVERY_S
    assert ring.find(A) is None and ring.find(B) == Key(name="ben")


def test_calls_of_plain_keys_are_bounded_and_those_of_the_file_by_their_entries(tmp_path: Path) -> None:
    write(tmp_path / "k", {"name": "ann", "sha256": A})
    ring = KeyRing({C: "carl"}, tmp_path / "k", requests_per_minute=5)
    assert ring.find(C) == Key(name="carl", requests_per_minute=5)
    assert ring.find(A) == Key(name="ann")


def test_the_file_goes_before_the_environment(tmp_path: Path) -> None:
    write(tmp_path / "k", {"name": "ann", "sha256": A, "scopes": ["read"]})
    assert KeyRing({A: "ann"}, tmp_path / "k").find(A) == Key(name="ann", scopes=frozenset({"read"}))


ENTRY = {"name": "ann", "sha256": A}


@pytest.mark.parametrize(
    ("document", "field"),
    [
        ([], ""),
        ({"keys": [ENTRY], "more": 1}, ".more"),
        ({"keys": [{**ENTRY, "scope": ["read"]}]}, ".keys.0.scope"),
        ({"keys": [{**ENTRY, "scopes": []}]}, ".keys.0.scopes"),
        ({"keys": [{**ENTRY, "scopes": ["write"]}]}, ".keys.0.scopes.0"),
        ({"keys": [{**ENTRY, "name": "ann/ben"}]}, ".keys.0.name"),
        ({"keys": [{**ENTRY, "not_after": "2030-01-01T00:00:00"}]}, ".keys.0.not_after"),
        ({"keys": [{**ENTRY, "not_after": 5}]}, ".keys.0.not_after"),
        ({"keys": [{**ENTRY, "requests_per_minute": 0}]}, ".keys.0.requests_per_minute"),
        ({"keys": [{**ENTRY, "requests_per_minute": "60"}]}, ".keys.0.requests_per_minute"),
        ({"keys": [{**ENTRY, "core_seconds_per_day": -1}]}, ".keys.0.core_seconds_per_day"),
        ({"keys": [ENTRY, {**ENTRY, "name": "ben"}]}, ".keys.1.sha256"),
        ({"keys": [{"name": "n", "sha256": f"{i:064x}"} for i in range(MAX_KEYS + 1)]}, ".keys"),
    ],
)
def test_what_is_wrong_is_named(document: object, field: str) -> None:
    with pytest.raises(SpecError) as caught:
        parse_key_file(json.dumps(document).encode())
    assert caught.value.problems[0].field == f"SIDEBAND_API_KEYS_FILE{field}"


def test_no_key_gets_into_a_message() -> None:
    with pytest.raises(SpecError) as caught:
        parse_key_file(b'{"keys": [{"name": "ann", "sha256": "sb_secret"}]}')
    assert "sb_secret" not in str(caught.value)


@pytest.mark.parametrize(
    "text", [b'{"keys": [], "keys": []}', b'{"keys": NaN}', b"\xff", b" " * (2**20 + 1), b"[" * 99]
)
def test_strict_and_bounded(tmp_path: Path, text: bytes) -> None:
    (tmp_path / "k").write_bytes(text)
    with pytest.raises(SpecError):
        read_keys(tmp_path / "k")
