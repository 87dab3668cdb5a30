"""Kept answers: made once, bounded, the least used go first, failures are not kept."""

from __future__ import annotations

import threading

import pytest

from jobs.kept import Kept


def test_what_is_kept_is_not_made_again() -> None:
    kept, made = Kept(), list[str]()
    for key in ("a", "b", "a", "a"):
        assert kept.get((key, "x"), lambda key=key: made.append(key) or key.encode()) == key.encode()
    assert made == ["a", "b"]


def test_least_used_go_when_the_bound_is_reached() -> None:
    kept, made = Kept(max_bytes=30), list[str]()

    def ask(key: str, size: int = 10) -> None:
        kept.get((key,), lambda: made.append(key) or bytes(size))

    for key in ("a", "b", "c", "a", "d", "a", "c", "b"):
        ask(key)
    assert made == ["a", "b", "c", "d", "b"]
    ask("huge", 31)
    ask("huge", 31)
    ask("b")
    assert made[5:] == ["huge", "huge"], "what is too large is not kept and pushes nothing out"


def test_failure_is_told_and_tried_again() -> None:
    kept = Kept()

    def fail() -> bytes:
        raise LookupError("no such channel")

    with pytest.raises(LookupError):
        kept.get(("a",), fail)
    assert kept.get(("a",), lambda: b"1") == b"1"


def test_threads_that_ask_together_wait_for_one_making() -> None:
    kept, made, go = Kept(), list[int](), threading.Event()
    answers: list[object] = []

    def make() -> bytes:
        made.append(1)
        go.wait(10)
        return b"made"

    def fail() -> bytes:
        go.wait(10)
        raise LookupError("told to all")

    def ask(key: str, how: object) -> None:
        try:
            answers.append(kept.get((key,), how))  # type: ignore[arg-type]
        except LookupError as error:
            answers.append(str(error))

    asked = [threading.Thread(target=ask, args=pair) for pair in [("a", make)] * 5 + [("b", fail)] * 3]
    for thread in asked:
        thread.start()
    go.set()
    for thread in asked:
        thread.join()
    assert len(made) == 1 and answers.count(b"made") == 5 and answers.count("told to all") == 3
