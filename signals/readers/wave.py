"""WAV by SciPy. Whole-number samples are shares of full scale (-1 to 1), as audio tools have it."""

from __future__ import annotations

import io
import json
import math
import struct
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np
from scipy.io import wavfile

from signals.readers.contents import AnyArray, Contents, Entry, told
from signals.readers.limits import Bounds
from signals.readers.riff import OPEN_ENDED, samples_of

_COMMENT_BYTES = 2**20
_LARGEST_SAMPLE = 8


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Channels `channel1`, `channel2` ... (`channel` if alone), also by number from 0.

    A file that `signals.encode` wrote has their names and scales in its comment, which are applied.
    """
    with told(path), warnings.catch_warnings():
        warnings.simplefilter("ignore", wavfile.WavFileWarning)  # unknown chunks are no matter
        rate, values = wavfile.read(_closed(path, bounds) or path)
        _check_count(path, int(values.size), bounds)
        samples = np.atleast_2d(_full_scale(values).T)
        written = _comment(path)
    names, scales, exact = _names(samples.shape[0], written)
    entries = {
        name: Entry(load=partial(np.multiply, row, scale), shape=row.shape)
        for name, row, scale in zip(names, samples, scales, strict=True)
    }
    yield Contents(entries=entries, rate_hz=exact or float(rate), numbered=True)


def _check_count(path: Path, count: int, bounds: Bounds) -> None:
    bounds.check(path.name, message="holds too many samples", given=count, allowed=bounds.values, unit="samples")


def _closed(path: Path, bounds: Bounds) -> io.BytesIO | None:
    """The file with the length of its samples stated, where its writer left that open: as many as whole frames come."""
    size = path.stat().st_size
    with path.open("rb") as stream:
        found = samples_of(stream)
        stream.seek(0)
        if found is None or found.length not in OPEN_ENDED or found.frame == 0 or stream.read(4) == b"RF64":
            return None
        there = (size - found.at) // found.frame * found.frame
        if found.length <= there:
            return None
        _check_count(path, there // _LARGEST_SAMPLE, bounds)
        stream.seek(0)
        head, samples = stream.read(found.at - 4), stream.read(there + 4)[4:]
    return io.BytesIO(head + struct.pack(f"{found.order}I", there) + samples)


def _full_scale(values: AnyArray) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    kind, bits = values.dtype.kind, values.dtype.itemsize * 8
    if kind == "f":
        return values.astype(np.float64)
    middle = 2.0 ** (bits - 1)
    # 8-bit samples are unsigned around 128; 24-bit ones come in the upper bytes of 32.
    return (values.astype(np.float64) - (middle if kind == "u" else 0.0)) / middle


def _names(count: int, written: dict[str, object] | None) -> tuple[list[str], list[float], float | None]:
    """Names and scales of the channels, and the exact rate where the comment has it."""
    plain = ["channel"] if count == 1 else [f"channel{i + 1}" for i in range(count)]
    if written is None:
        return plain, [1.0] * count, None
    try:
        rate, channels = float(str(written["sampling_rate_hz"])), written["channels"]
        assert isinstance(channels, list) and len(channels) == count and math.isfinite(rate)
        return [str(c["name"]) for c in channels], [float(c["scale"]) for c in channels], rate
    except (KeyError, TypeError, ValueError, AssertionError):
        return plain, [1.0] * count, None


def _comment(path: Path) -> dict[str, object] | None:
    """The JSON in the file's comment (RIFF INFO chunk ICMT), if there is one."""
    with path.open("rb") as stream:
        stream.seek(12)
        while len(head := stream.read(8)) == 8:
            name, size = head[:4], struct.unpack("<I", head[4:])[0]
            if name == b"LIST" and size <= _COMMENT_BYTES:
                return _json_of(stream.read(size))
            stream.seek(size + size % 2, 1)
    return None


def _json_of(chunk: bytes) -> dict[str, object] | None:
    at = chunk.find(b"ICMT")
    if at < 0 or len(chunk) < at + 8:
        return None
    size = struct.unpack("<I", chunk[at + 4 : at + 8])[0]
    try:
        found = json.loads(chunk[at + 8 : at + 8 + size].rstrip(b"\0"))
    except ValueError:
        return None
    return found if isinstance(found, dict) else None
