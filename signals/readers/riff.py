"""Where the samples of a WAV file stand, and whether its writer knew how many would come."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import BinaryIO

OPEN_ENDED = (2**32 - 1, 2**32 - 1 - 36, 2**31 - 1, 0x7FFFF000)
"""Lengths of streams, which writers leave where they do not know them: the samples reach to the end of the file."""
_MOST_CHUNKS = 100_000


@dataclass(frozen=True, kw_only=True)
class Samples:
    """The chunk of samples: `at` is its first byte, `length` what it states, `frame` the bytes of one instant.

    `order`: `<` or `>`, as `struct` has it. `frame` is 0 where the file does not say it before.
    """

    at: int
    length: int
    frame: int
    order: str


def samples_of(stream: BinaryIO) -> Samples | None:
    """None where the file ends before any samples."""
    stream.seek(0)
    order, at, frame = ">" if stream.read(12)[:4] == b"RIFX" else "<", 12, 0
    for _ in range(_MOST_CHUNKS):
        stream.seek(at)
        tag = stream.read(8)
        if len(tag) < 8:
            return None
        length = struct.unpack(f"{order}I", tag[4:])[0]
        if tag[:4] == b"data":
            return Samples(at=at + 8, length=length, frame=frame, order=order)
        if tag[:4] == b"fmt " and len(head := stream.read(14)) == 14:
            frame = struct.unpack(f"{order}H", head[12:])[0]
        at += 8 + length + length % 2
    return None
