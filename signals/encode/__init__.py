"""Recordings as files: pure encoders to bytes, the same recording giving the same bytes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Literal, get_args

from signals.encode.binary import encode_mat, encode_npz, encode_parquet, encode_wav
from signals.encode.table import Table, describe, table
from signals.encode.text import encode_csv, encode_uff58
from signals.recording import Recording
from sim.core.errors import UnknownName

Format = Literal["csv", "npz", "wav", "parquet", "mat", "uff"]
FORMATS: tuple[str, ...] = get_args(Format)
MEDIA_TYPES: Mapping[str, str] = {
    "csv": "text/csv",
    "npz": "application/x-npz",
    "wav": "audio/wav",
    "parquet": "application/vnd.apache.parquet",
    "mat": "application/x-matlab-data",
    "uff": "text/plain",
}
_ENCODERS: Mapping[str, Callable[[Table], bytes]] = {
    "csv": encode_csv,
    "npz": encode_npz,
    "wav": encode_wav,
    "parquet": encode_parquet,
    "mat": encode_mat,
    "uff": encode_uff58,
}


def encode(recording: Recording, fmt: str) -> bytes:
    """The recording as a file of format `fmt`; UnknownName lists the formats."""
    if fmt not in _ENCODERS:
        raise UnknownName("format", fmt, FORMATS)
    return _ENCODERS[fmt](table(recording))


__all__ = ["FORMATS", "MEDIA_TYPES", "Format", "describe", "encode"]
