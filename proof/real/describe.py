"""Descriptions for the measured recordings beside the project (`../shared/recordings`), as a customer would write them.

Numbers and units only: condition, fault and source are left out, and the copy's name is the caller's choice, because
the files' own names carry the answer. Uses nothing of the product.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

Document = dict[str, Any]
TEST_RIG, MOTOR, INPUT = "shaft", "motor", "input"


@dataclass(frozen=True, kw_only=True)
class Rig:
    """How the files of one data set are described.

    `stated_hz`: the speed by the file's name or the source's text, where that differs from what the data show;
    `convert`: makes a copy in a form that is read, ending in `suffix`.
    """

    channels: tuple[Document, ...]
    shaft: str = ""
    rate_hz: float | None = None
    stated_hz: Callable[[str], float] | None = None
    time: Document | None = None
    convert: Callable[[Path, Path], None] | None = None
    suffix: str | None = None


def _rpm_before(part: int) -> Callable[[str], float]:
    """Revolutions per second from the rpm that stand in the file's name, parted by underscores."""
    return lambda name: float(name.removesuffix(".mat").split("_")[part]) / 60


def _acceleration(name: str, unit: str, **further: object) -> Document:
    return {"name": name, "quantity": "acceleration", "unit": unit, **further}


def _phone(source: Path, target: Path) -> None:
    """Records parted by `;`, between a line of 999 and one of 111, as lines."""
    records = [record for record in source.read_text().split(";") if record.strip()]
    kept = [r for r in records if not r.startswith(("999,", "111,"))]
    target.write_text("x_avg,y_avg,z_avg,x,y,z,timestamp [ms]\n" + "\n".join(kept) + "\n")


_IN_PHONE = tuple(_acceleration(axis, "m/s^2", location="phone", axis=axis) for axis in ("x", "y", "z"))
RIGS: Mapping[str, Rig] = {
    "cwru": Rig(
        channels=(
            _acceleration("DE", "g", location="drive_end", axis="y"),
            _acceleration("FE", "g", location="fan_end", axis="y"),
        ),
        shaft=MOTOR,
        stated_hz=lambda _: 1797 / 60,
    ),
    "uestc": Rig(
        channels=(_acceleration("casing", "uncalibrated", column="Data", location="bearing"),),
        shaft=TEST_RIG,
        stated_hz=_rpm_before(1),
    ),
    # the one array of each file has a name of its own
    "hit_sm_mfs": Rig(
        channels=(_acceleration("seat", "uncalibrated", location="bearing", axis="y"),),
        shaft=TEST_RIG,
        stated_hz=_rpm_before(-1),
    ),
    "openei_gear": Rig(
        channels=tuple(_acceleration(f"a{i}", "uncalibrated") for i in (1, 2, 3, 4)),
        shaft=INPUT,
        stated_hz=lambda _: 30.0,
    ),
    "ims_healthy": Rig(
        channels=tuple(
            _acceleration(f"ch{i + 1}", "g", column=i, location=f"bearing{i // 2 + 1}", axis="xy"[i % 2])
            for i in range(8)
        ),
        shaft=TEST_RIG,
    ),
    "motor_acoustic": Rig(
        channels=(
            {"name": "microphone", "quantity": "sound pressure", "unit": "uncalibrated", "location": "near motor"},
        ),
        shaft=MOTOR,
        stated_hz=lambda _: 15.0,
    ),
    "motor_phone_accel": Rig(
        channels=_IN_PHONE,
        shaft=MOTOR,
        time={"column": "timestamp", "unit": "ms"},
        convert=_phone,
        suffix=".csv",
    ),
    "silverbox": Rig(
        channels=(
            {"name": "input", "column": "V1", "quantity": "force", "unit": "V"},
            {"name": "output", "column": "V2", "quantity": "displacement", "unit": "V"},
        ),
        rate_hz=1e7 / 2**14,
    ),
    "cascaded_tanks": Rig(
        channels=tuple(
            {"name": name, "quantity": quantity, "unit": "V"}
            for name, quantity in (("uEst", "pump"), ("yEst", "level"), ("uVal", "pump"), ("yVal", "level"))
        ),
    ),
    "brfd_backlash": Rig(
        channels=(
            {"name": "displacement", "column": "data[:,1]", "quantity": "displacement", "unit": "in"},
            {"name": "friction", "column": "data[:,2]", "quantity": "force", "unit": "kip"},
            {"name": "velocity", "column": "data[:,3]", "quantity": "velocity", "unit": "in/s"},
            {"name": "actuator1", "column": "data[:,4]", "quantity": "force", "unit": "lbf"},
            {"name": "actuator2", "column": "data[:,5]", "quantity": "force", "unit": "lbf"},
        ),
        time={"column": "data[:,0]", "unit": "s"},
    ),
}


def index(recordings: Path) -> Document:
    """The catalogue of the recordings: `recordings` (file, rate, speed, truth) and `pairs` (baseline, test, truth)."""
    document: Document = json.loads((recordings / "index.json").read_text(encoding="utf-8"))
    return document


def description(entry: Mapping[str, Any], *, condition: str = "unknown", measured_speed: bool = False) -> Document:
    """The description of one entry of the catalogue, without its truth.

    Speed: as the source states it (up to 7 % wrong in one set), or with `measured_speed` as the lines in the data say.
    """
    rig = RIGS[entry["dataset"]]
    document: Document = {"channels": [dict(channel) for channel in rig.channels], "condition": condition}
    rate = rig.rate_hz or entry["fs_hz"]
    if rate is not None:
        document["sampling_rate_hz"] = rate
    if rig.time is not None:
        document["time"] = rig.time
    speed = entry["shaft_speed_hz"]
    if rig.stated_hz is not None and not measured_speed:
        speed = rig.stated_hz(Path(entry["file"]).name)
    if rig.shaft and speed is not None:
        document["operating"] = {"shaft": rig.shaft, "speed_hz": speed}
    return document


def write(
    recordings: Path,
    entry: Mapping[str, Any],
    folder: Path,
    stem: str,
    *,
    condition: str = "unknown",
    measured_speed: bool = False,
) -> Path:
    """A copy of one recording under a name that tells nothing, with its description; returns the description's path."""
    rig = RIGS[entry["dataset"]]
    source = recordings / entry["file"]
    suffix = rig.suffix or "".join(source.suffixes[-2:] if source.suffix == ".gz" else [source.suffix])
    # a data file in JSON must not take the description's name
    data = folder / (f"{stem}_data{suffix}" if suffix == ".json" else f"{stem}{suffix}")
    (rig.convert or shutil.copyfile)(source, data)
    document = description(entry, condition=condition, measured_speed=measured_speed)
    path = folder / f"{stem}.json"
    path.write_text(json.dumps({**document, "data": data.name}, indent=1), encoding="utf-8")
    return path
