"""Binary formats. The same table gives the same bytes: no clock, no platform, no random order in the file."""

from __future__ import annotations

import io
import json
import struct
import zipfile

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.lib.format import write_array
from scipy.io import savemat

from signals.encode.table import Table
from signals.names import matlab_name
from sim.core.errors import Problem, SpecError

ZIP_EPOCH = (1980, 1, 1, 0, 0, 0)
"""The earliest time a zip member can carry, in place of the clock."""
MAT_HEADER = b"MATLAB 5.0 MAT-file, written by Sideband"
MAT_HEADER_BYTES = 116
"""Length of the free text in a level 5 MAT-file, which SciPy fills with platform and time."""
WAVE_FORMAT_IEEE_FLOAT = 3


def encode_npz(data: Table) -> bytes:
    """Compressed npz: one float64 array a channel, `sampling_rate_hz`, `start_s`, `description` (JSON text)."""
    arrays: dict[str, np.ndarray[tuple[int, ...], np.dtype[np.generic]]] = {
        "sampling_rate_hz": np.array(data.sampling_rate_hz),
        "start_s": np.array(data.start_s),
        "description": np.array(data.description),
    }
    taken = [name for name in data.names if name in arrays]
    if taken:
        message = "is a name the file needs for itself; rename the channel"
        raise SpecError(Problem(field="channels", message=message, given=taken[0]))
    arrays.update(zip(data.names, data.columns, strict=True))
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=4) as archive:
        for name, values in arrays.items():
            member = io.BytesIO()
            write_array(member, np.asarray(values, order="C"), allow_pickle=False)
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=ZIP_EPOCH)
            entry.create_system = 3  # the same on every platform
            archive.writestr(entry, member.getvalue(), compress_type=zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def encode_mat(data: Table) -> bytes:
    """Level 5 MAT-file: one column vector a channel (names made valid for MATLAB), rate, start and description."""
    arrays: dict[str, object] = {
        "sampling_rate_hz": data.sampling_rate_hz,
        "start_s": data.start_s,
        "description": data.description,
    }
    for name, column in zip(data.names, data.columns, strict=True):
        valid = matlab_name(name)
        if valid in arrays:
            message = "gives the same MATLAB name as another; rename the channel"
            raise SpecError(Problem(field="channels", message=message, given=name))
        arrays[valid] = column.reshape(-1, 1)
    buffer = io.BytesIO()
    savemat(buffer, arrays, format="5", do_compression=True, long_field_names=True)  # type: ignore[arg-type]
    return MAT_HEADER.ljust(MAT_HEADER_BYTES) + buffer.getvalue()[MAT_HEADER_BYTES:]


def encode_wav(data: Table) -> bytes:
    """WAV of 32-bit floats. A channel's samples times its `scale` (in the comment, JSON) are in its unit.

    `scale` is the largest magnitude of the channel, so the file never clips and any player can open it.
    WAV holds whole rates only: the exact one is in the comment too.
    """
    scales = [max(float(np.max(np.abs(c))), float(np.finfo(np.float32).tiny)) for c in data.columns]
    frames = np.stack([c / s for c, s in zip(data.columns, scales, strict=True)], axis=1).astype("<f4")
    if not np.all(np.isfinite(frames)):
        raise SpecError(Problem(field="samples", message="must be finite numbers to be written as WAV"))
    rate = max(1, round(data.sampling_rate_hz))
    channels = [{"name": n, "unit": u, "scale": s} for n, u, s in zip(data.names, data.units, scales, strict=True)]
    exact = {"sampling_rate_hz": data.sampling_rate_hz, "start_s": data.start_s, "channels": channels}
    comment = json.dumps(exact, sort_keys=True, separators=(",", ":")).encode("ascii") + b"\0"
    block = 4 * len(scales)
    layout = struct.pack("<HHIIHHH", WAVE_FORMAT_IEEE_FLOAT, len(scales), rate, rate * block, block, 32, 0)
    chunks = (
        _chunk(b"fmt ", layout)
        + _chunk(b"fact", struct.pack("<I", frames.shape[0]))
        + _chunk(b"LIST", b"INFO" + _chunk(b"ICMT", comment))
        + _chunk(b"data", frames.tobytes())
    )
    return b"RIFF" + struct.pack("<I", 4 + len(chunks)) + b"WAVE" + chunks


def encode_parquet(data: Table) -> bytes:
    """Parquet: one float64 column a channel with its unit in the field, the description in the schema."""
    fields = [
        pa.field(n, pa.float64(), nullable=False, metadata={"unit": u})
        for n, u in zip(data.names, data.units, strict=True)
    ]
    schema = pa.schema(fields, metadata={"sideband": data.description})
    columns = pa.table([pa.array(c) for c in data.columns], schema=schema)
    sink = pa.BufferOutputStream()
    pq.write_table(columns, sink, compression="zstd")
    return bytes(sink.getvalue())


def _chunk(name: bytes, body: bytes) -> bytes:
    """A RIFF chunk, padded to an even length."""
    return name + struct.pack("<I", len(body)) + body + b"\0" * (len(body) % 2)
