"""The measured recordings: samples, what is told of them, and the truth the answer is held against."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import loadmat, wavfile

from learn.orders import FaultOrders, from_geometry
from signals.series import FloatArray
from sim.parts.bearing.catalogue import lookup

ROOT = Path(__file__).resolve().parents[2]
RECORDINGS = ROOT.parent / "shared" / "recordings"
BEARINGS = {"cwru": "6205", "hit_sm_mfs": "6205", "uestc": "UC204", "ims_healthy": "ZA-2115"}
"""Sizes as the sources state them. Not of `uestc`, whose source states the series only: its 8 balls were inferred from
orders found in the recordings themselves, and 204 is an insert of the series that fits."""
LABELS = {"healthy": "healthy", "outer-race": "outer", "inner-race": "inner", "ball": "ball", "broken": "tooth"}
TEETH = {"openei_gear": (32, 80)}
"""Of the stage on the shaft whose speed is told: as seen in the recordings' lines, the source does not state them."""
MIDDLE = (0.2, 0.8)
"""Share of a sound file that is used: some begin and end with a synchronising noise."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """One recording. `channels` (c, n); speeds in Hz: as measured from its lines, and as its source states it."""

    rig: str
    name: str
    label: str
    channels: FloatArray
    rate_hz: float
    speed_hz: float
    stated_hz: float
    orders: FaultOrders | None
    size: float | None
    """Arc of the defect, degrees, where the source says."""
    teeth: tuple[int, int] | None = None
    """Of a gear stage, the gear on the shaft whose speed is told first."""


def available(folder: Path = RECORDINGS) -> bool:
    """Whether the recordings are there."""
    return (folder / "index.json").is_file()


def index(folder: Path = RECORDINGS) -> list[dict[str, Any]]:
    """Entries of the catalogue."""
    rows: list[dict[str, Any]] = json.loads((folder / "index.json").read_text(encoding="utf-8"))["recordings"]
    return rows


def case(entry: Mapping[str, Any], folder: Path = RECORDINGS) -> Case:
    """One entry with its samples."""
    rig, path = str(entry["dataset"]), folder / str(entry["file"])
    size = BEARINGS.get(rig)
    speed = float(entry["shaft_speed_hz"])
    return Case(
        rig=rig,
        name=path.name.split(".")[0] if rig != "ims_healthy" else path.name,
        label=label(str(entry["condition"])),
        channels=_samples(rig, path),
        rate_hz=float(entry["fs_hz"]),
        speed_hz=speed,
        stated_hz=_stated(rig, path.name, speed),
        orders=from_geometry(lookup(size).geometry()) if size else None,
        size=_arc(path.name) if rig == "hit_sm_mfs" else None,
        teeth=TEETH.get(rig),
    )


def label(condition: str) -> str:
    """Class of a condition as the catalogue words it."""
    return next((name for start, name in LABELS.items() if condition.startswith(start)), "other")


def _samples(rig: str, path: Path) -> FloatArray:
    if rig == "cwru":
        with np.load(path, allow_pickle=False) as data:
            return np.asarray(data["DE"], dtype=np.float64).reshape(1, -1)
    if rig in ("uestc", "hit_sm_mfs"):
        found = loadmat(path)
        arrays = {k: v for k, v in found.items() if not k.startswith("__")}
        values = arrays["Data"] if rig == "uestc" else next(iter(arrays.values()))
        return np.asarray(values, dtype=np.float64).reshape(1, -1)
    if rig == "openei_gear":
        return np.asarray(np.loadtxt(path, delimiter=",", skiprows=1).T, dtype=np.float64)
    if rig == "ims_healthy":
        return np.asarray(np.loadtxt(path).T, dtype=np.float64)
    if rig == "motor_acoustic":
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wavfile.WavFileWarning)  # chunks of the recorder's own
            values = np.asarray(wavfile.read(path)[1], dtype=np.float64)
        low, high = (int(share * values.shape[0]) for share in MIDDLE)
        return values[low:high].reshape(1, -1)
    raise ValueError(f"{rig}: no way to read its files is written")


def _stated(rig: str, name: str, speed: float) -> float:
    """Nominal speed: from the file's name, or the source's text, where that is less exact than the data."""
    stem = name.removesuffix(".mat")
    if rig == "uestc":
        return float(stem.split("_")[1]) / 60
    if rig == "hit_sm_mfs":
        return float(stem.split("_")[-1]) / 60
    return {"cwru": 1797 / 60, "openei_gear": 30.0, "motor_acoustic": 15.0}.get(rig, speed)


def _arc(name: str) -> float | None:
    word = name.split("_")[2]
    return float(word[2:]) if word[:2] in ("OR", "IR") else None
