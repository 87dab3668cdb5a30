"""A recording from a file: npz, mat, wav or csv, with a description in JSON beside it (same stem) or by options.

The description: {"sampling_rate_hz", "channels": [{"name", "column", "quantity", "unit", "location", "axis"}],
"operating": {"shaft", "speed_hz", "torque_nm"}, "tacho": {"shaft", "column", "pulses_per_revolution"}, "notes"}.
Rates and units are never guessed: what neither the description nor the file nor the options say is refused.
"""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import loadmat, wavfile

from app.cli.files import read_json
from signals.angle.pulses import recorded_tacho
from signals.recording import Operating, Recording
from signals.series import FloatArray, Series
from sim.core.errors import Problem, SpecError
from sim.core.response import Channel

SUFFIXES = (".npz", ".mat", ".wav", ".csv")


@dataclass(frozen=True, kw_only=True)
class Given:
    """What the options say in place of a description."""

    sampling_rate_hz: float | None = None
    unit: str | None = None


def read_recording(path: Path, given: Given) -> Recording:
    """The recording in a file; SpecError says what is missing or broken."""
    if path.suffix.lower() not in SUFFIXES:
        allowed = f"a result folder, or a file {', '.join(SUFFIXES)}"
        raise SpecError(Problem(field=str(path), message="is no recording", given=path.suffix, allowed=allowed))
    beside = path.with_suffix(".json")
    about: dict[str, Any] = read_json(beside) if beside.is_file() else {}
    columns, rate_of_file = _columns(path)
    rate = given.sampling_rate_hz or about.get("sampling_rate_hz") or rate_of_file
    if rate is None:
        message = "has no sampling rate: give --rate, or sampling_rate_hz in the description"
        raise SpecError(Problem(field=str(path), message=message, unit="Hz"))
    entries = _entries(path, about, columns, given)
    chosen = [_column(path, columns, str(entry.get("column", entry["name"]))) for entry in entries]
    if len({row.size for row in chosen}) != 1:
        message = "has channels of unequal length; name those of one length in the description"
        raise SpecError(Problem(field=str(path), message=message, given=[row.size for row in chosen]))
    operating = about.get("operating")
    recording = Recording(
        sampling_rate_hz=float(rate),
        channels=tuple(_channel(entry) for entry in entries),
        samples=np.array(chosen),
        operating=_operating(path, operating) if operating is not None else None,
        notes=str(about.get("notes", "")),
    )
    return _with_tacho(recording, path, columns, about.get("tacho"))


def _entries(path: Path, about: Mapping[str, Any], columns: Mapping[str, FloatArray], given: Given) -> list[Any]:
    entries = about.get("channels") or [{"name": name} for name, row in columns.items() if row.size > 1]
    if not isinstance(entries, list) or not all(isinstance(e, dict) and e.get("name") for e in entries):
        raise SpecError(Problem(field=f"{path.stem}.json: channels", message="must be a list of objects with a name"))
    problems = []
    for i, entry in enumerate(entries):
        entry.setdefault("unit", given.unit)
        if not entry["unit"]:
            message = "is not stated: give --unit, or unit in the description ('1' means dimensionless)"
            problems.append(Problem(field=f"channels[{i}].unit", message=message, given=entry["name"]))
    if problems:
        raise SpecError(problems)
    return entries


def _channel(entry: Mapping[str, Any]) -> Channel:
    return Channel(
        name=str(entry["name"]),
        quantity=str(entry.get("quantity", "")),
        unit=str(entry["unit"]),
        location=str(entry.get("location", "")),
        axis=str(entry.get("axis", "")),
    )


def _operating(path: Path, entry: Mapping[str, Any]) -> Operating:
    try:
        return Operating(shaft=str(entry["shaft"]), speed_hz=float(entry["speed_hz"]), torque_nm=entry.get("torque_nm"))
    except (KeyError, TypeError, ValueError) as error:
        message = "needs shaft and speed_hz"
        raise SpecError(Problem(field=f"{path.stem}.json: operating", message=message, given=str(entry))) from error


def _with_tacho(
    recording: Recording, path: Path, columns: Mapping[str, FloatArray], entry: Mapping[str, Any] | None
) -> Recording:
    if entry is None:
        return recording
    field = f"{path.stem}.json: tacho"
    if not isinstance(entry, dict) or not {"shaft", "column"} <= set(entry):
        raise SpecError(Problem(field=field, message="needs shaft and column", given=str(entry)))
    pulses = entry.get("pulses_per_revolution", 1)
    if not isinstance(pulses, int) or pulses < 1:
        raise SpecError(Problem(field=f"{field}.pulses_per_revolution", message="must be a whole number", given=pulses))
    samples = _column(path, columns, str(entry["column"]))
    series = Series(samples=samples, sampling_rate_hz=recording.sampling_rate_hz, unit="1", name="tacho")
    tacho = recorded_tacho(series, shaft=str(entry["shaft"]), pulses_per_revolution=pulses)
    return Recording(**{**vars(recording), "tacho": tacho})


def _column(path: Path, columns: Mapping[str, FloatArray], name: str) -> FloatArray:
    if name not in columns:
        problem = Problem(field=str(path), message="has no such column", given=name, allowed=", ".join(columns))
        raise SpecError(problem)
    return columns[name]


def _columns(path: Path) -> tuple[dict[str, FloatArray], float | None]:
    """Columns by name, each (n,), and the sampling rate if the file has one."""
    try:
        return _READERS[path.suffix.lower()](path)
    except (ValueError, TypeError, KeyError, IndexError, NotImplementedError, zipfile.BadZipFile, EOFError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise SpecError(Problem(field=str(path), message=f"cannot be read: {reason}")) from error


def _npz(path: Path) -> tuple[dict[str, FloatArray], float | None]:
    with np.load(path, allow_pickle=False) as file:
        return _rows({name: file[name] for name in file.files})


def _mat(path: Path) -> tuple[dict[str, FloatArray], float | None]:
    return _rows({name: value for name, value in loadmat(path).items() if not name.startswith("__")})


def _wav(path: Path) -> tuple[dict[str, FloatArray], float | None]:
    rate, values = wavfile.read(path)
    return _rows({"channel": np.asarray(values, dtype=np.float64).T})[0], float(rate)


def _csv(path: Path) -> tuple[dict[str, FloatArray], float | None]:
    with path.open(encoding="utf-8") as file:
        names = [name.strip() for name in file.readline().split(",")]
        values = np.loadtxt(file, delimiter=",", ndmin=2)
    if values.shape[1] != len(names):
        raise ValueError(f"{len(names)} names in the first line, {values.shape[1]} columns below")
    return {name: values[:, i] for i, name in enumerate(names)}, None


def _rows(arrays: Mapping[str, Any]) -> tuple[dict[str, FloatArray], float | None]:
    """Numeric arrays as columns; of a matrix each row or column, whichever are fewer, by number."""
    found: dict[str, FloatArray] = {}
    for name, value in arrays.items():
        array = np.squeeze(np.asarray(value))
        if array.dtype.kind not in "fiu" or array.ndim > 2:
            continue
        if array.ndim < 2:
            found[name] = np.atleast_1d(array).astype(np.float64)
            continue
        rows = array if array.shape[0] <= array.shape[1] else array.T
        found |= {f"{name}.{i}": row.astype(np.float64) for i, row in enumerate(rows, start=1)}
    rate = found.pop("sampling_rate_hz", None)
    found.pop("time_s", None)
    return found, float(rate[0]) if rate is not None else None


_READERS = {".npz": _npz, ".mat": _mat, ".wav": _wav, ".csv": _csv}
