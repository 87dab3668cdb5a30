"""Text formats: CSV and the universal file format, dataset 58."""

from __future__ import annotations

import csv
import io

import numpy as np

from signals.encode.table import Table
from signals.series import FloatArray

VALUES_PER_LINE = 4


def encode_csv(data: Table) -> bytes:
    """UTF-8 CSV: header `time_s,name [unit],...`, then shortest decimals that read back to the same floats."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["time_s", *(f"{n} [{u}]" for n, u in zip(data.names, data.units, strict=True))])
    # n / rate, not n * step: the product of a rounded step drifts
    times = data.start_s + np.arange(data.columns[0].size) / data.sampling_rate_hz
    writer.writerows(zip(times.tolist(), *(c.tolist() for c in data.columns), strict=True))
    return text.getvalue().encode()


def encode_uff58(data: Table) -> bytes:
    """ASCII universal file, one dataset 58 (time response, double precision, even spacing) a channel.

    Layout: SDRC/University of Cincinnati, "Universal file datasets", dataset 58 "Function at nodal DOF",
    records 1-12; 80 columns, data in 4E20.12.
    """
    blocks = [_dataset58(data, i) for i in range(len(data.names))]
    return "".join(blocks).encode("ascii", errors="replace")


def _dataset58(data: Table, row: int) -> str:
    values, unit, name = data.columns[row], data.units[row], data.names[row]
    records = [
        "    -1",
        "    58",
        f"{name[:80]:<80}",
        f"{'unit ' + unit:<80.80}",
        # the abscissa step below has six digits only
        f"{f'sampling rate {data.sampling_rate_hz!r} Hz':<80.80}",
        f"{'channel ' + name:<80.80}",
        f"{'NONE':<80}",
        # function type 1 (time response); response entity, node and direction, reference likewise
        f"{1:5d}{row + 1:10d}{0:5d}{0:10d} {'NONE':<10}{row + 1:10d}{0:4d} {'NONE':<10}{0:10d}{0:4d}",
        # 4: real double precision; 1: even abscissa spacing
        f"{4:10d}{values.size:10d}{1:10d}{data.start_s:13.5E}{1 / data.sampling_rate_hz:13.5E}{0:13.5E}",
        _axis(17, "Time", "s"),
        _axis(0, name, unit),
        _axis(0, "NONE", "NONE"),
        _axis(0, "NONE", "NONE"),
        *_lines(values),
        "    -1",
    ]
    return "\n".join(records) + "\n"


def _axis(kind: int, label: str, unit: str) -> str:
    return f"{kind:10d}{0:5d}{0:5d}{0:5d} {label:<20.20} {unit:<20.20}"


def _lines(values: FloatArray) -> list[str]:
    items = [f"{v:20.12E}" for v in values.tolist()]
    return ["".join(items[i : i + VALUES_PER_LINE]) for i in range(0, len(items), VALUES_PER_LINE)]
