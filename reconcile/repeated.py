"""The same samples sent twice: a comparison of a recording with itself says nothing, and twice is no more evidence."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

import numpy as np

from reconcile.stated import Given, given
from signals.recording import Recording
from sim.core.errors import Problem, SpecError


def check_repeated(tests: Sequence[Recording], baselines: Sequence[Recording]) -> None:
    """SpecError where two recordings begin with the same samples, as long as the shortest; single precision, so that
    another format of the file is found too. Of channels that are silent or stuck the gate speaks."""
    several = [one for one in given(tests, baselines) if _moves(one.recording)]
    shortest = min((one.recording.samples.shape[1] for one in several), default=0)
    first: dict[bytes, Given] = {}
    problems = []
    for one in several:
        earlier = first.setdefault(_print(one.recording, shortest), one)
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


def _print(recording: Recording, count: int) -> bytes:
    begins = np.ascontiguousarray(recording.samples[:, :count], dtype=np.float32)
    return hashlib.blake2b(begins.tobytes(), digest_size=16, key=f"{begins.shape}".encode()).digest()
