"""The same samples sent twice: a comparison of a recording with itself says nothing, and twice is no more evidence."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

from reconcile.stated import Given, given
from signals.recording import Recording
from sim.core.errors import Problem, SpecError


def check_repeated(tests: Sequence[Recording], baselines: Sequence[Recording]) -> None:
    """SpecError where two recordings hold the same samples; of channels that are silent or stuck the gate speaks."""
    first: dict[bytes, Given] = {}
    problems = []
    for one in given(tests, baselines):
        if not _moves(one.recording):
            continue
        earlier = first.setdefault(_print(one.recording), one)
        if earlier is one:
            continue
        itself = " (a recording against itself shows no change)" if earlier.kind != one.kind else ""
        problems.append(
            Problem(
                field=one.field("samples"),
                message=f"holds the same samples as {earlier.field('samples')}{itself}",
                given="the same recording twice",
                allowed="every recording once",
            )
        )
    if problems:
        raise SpecError(problems)


def _moves(recording: Recording) -> bool:
    return bool(recording.samples.size) and bool((recording.samples != recording.samples[:, :1]).any())


def _print(recording: Recording) -> bytes:
    shape = f"{recording.samples.shape}{recording.samples.dtype}".encode()
    return hashlib.blake2b(recording.samples.tobytes(), digest_size=16, key=shape[:64]).digest()
