"""What is told of the rigs, which recordings are compared, and what is known of them that the engine is not told."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

Document = Mapping[str, Any]
SUFFIXES = (".csv.gz", ".npz", ".mat", ".txt", ".wav", ".dat", ".json", ".csv")


@dataclass(frozen=True, kw_only=True)
class Known:
    """What is told of a rig: its shaft's name in the descriptions, bearings, gears and meshes."""

    shaft: str
    bearings: tuple[Document, ...] = ()
    gears: tuple[Document, ...] = ()

    def document(self) -> Document:
        """The kinematics as a machine file."""
        shafts = [{"name": self.shaft}] + ([{"name": "second"}] if self.gears else [])
        found: dict[str, Any] = {"shafts": shafts}
        if self.bearings:
            found["bearings"] = [{**b, "shaft": self.shaft} for b in self.bearings]
        if self.gears:
            found["gears"] = list(self.gears)
            found["meshes"] = [{"name": "mesh1", "gears": [g["name"] for g in self.gears]}]
        return {"kinematics": found}


def _bearings(**sizes: str) -> tuple[Document, ...]:
    return tuple({"name": name, "catalogue": size} for name, size in sizes.items())


KNOWN = {
    "cwru": Known(shaft="motor", bearings=_bearings(drive_end="6205", fan_end="6203")),
    "hit_sm_mfs": Known(shaft="shaft", bearings=_bearings(bearing="6205")),
    "uestc": Known(shaft="shaft", bearings=_bearings(bearing="UC204")),
    "ims_healthy": Known(shaft="shaft", bearings=_bearings(bearing1="ZA-2115")),
    "openei_gear": Known(
        shaft="input",
        gears=(
            {"name": "pinion", "shaft": "input", "teeth": 32},
            {"name": "gear", "shaft": "second", "teeth": 80},
        ),
    ),
    "motor_acoustic": Known(shaft="motor"),
    "motor_phone_accel": Known(shaft="motor"),
}
PAIRS = (
    ("hit_mfs_Normal_1200", "hit_mfs_OR2_1200"), ("hit_mfs_Normal_1200", "hit_mfs_OR8_1200"),
    ("hit_mfs_OR2_1200", "hit_mfs_OR8_1200"),
    ("hit_mfs_Normal_1200", "hit_mfs_IR2_1200"), ("hit_mfs_Normal_1200", "hit_mfs_IR8_1200"),
    ("hit_mfs_Normal_600", "hit_mfs_OR5_600"),
    ("cwru_1797rpm_normal_first_half", "cwru_1797rpm_outerrace_007in_6oclock"),
    ("cwru_1797rpm_normal_first_half", "cwru_1797rpm_innerrace_007in"),
    ("cwru_1797rpm_normal_first_half", "cwru_1797rpm_ball_007in"),
    ("N_1000_1", "O_1000_1"), ("N_1000_1", "I_1000_1"), ("N_1000_1", "B_1000_1"),
    ("h30hz50", "b30hz50"), ("h30hz80", "b30hz80"), ("h30hz0", "h30hz80"),
    ("2003.10.22.12.09.13", "2003.10.22.12.39.13"),
    ("Motor1_Healthy_NewBearingHi-Fi_3_7cm_30Hz", "Motor1_DamagedBearing_SevereHi-Fi_02_7cm_30Hz"),
    ("Motor1_Healthy_Yaxis_30Hz", "Motor1_UnbalancedRotor_2Weights_Yaxis_30Hz"),
)  # fmt: skip
"""Baseline and test, by the stems of their files."""
TUNED = "hit_sm_mfs"
"""The rig the engine was tuned on."""
TERMS = {
    "outer-race fault": ("outer_spall",),
    "inner-race fault": ("inner_spall",),
    "ball fault": ("ball_spall",),
    "broken tooth": ("missing_tooth",),
    "bearing fault": ("outer_spall", "inner_spall", "ball_spall"),
    "unbalance (2 weights)": ("unbalance",),
}
"""Effects that are the truth, by the catalogue's condition; what is not here is healthy."""
SITES = {"cwru": "drive_end"}
"""Where the fault sits, of rigs with more than one bearing."""
PITCH_M, BALL_M = 39.04e-3, 7.94e-3
"""Of the 6205 in `hit_sm_mfs`, by the catalogue of the recordings."""
ARCS_DEG = {"OR2": 2.0, "OR8": 8.0, "IR2": 2.0, "IR8": 8.0, "OR5": 5.0}
WIDTHS_M = {
    "cwru_1797rpm_outerrace_007in_6oclock": 0.178e-3,
    "cwru_1797rpm_innerrace_007in": 0.178e-3,
    "cwru_1797rpm_ball_007in": 0.178e-3,
    "O_1000_1": 0.55e-3,
    "I_1000_1": 0.55e-3,
    "B_1000_1": 3e-3,
}
"""Lengths of the seeded defects along the race as their sources state them (0.007 inch, a cut of 0.55 mm)."""


def stem(entry: Document) -> str:
    """The file's name without its ending."""
    name = Path(str(entry["file"])).name
    for suffix in SUFFIXES:
        name = name.removesuffix(suffix)
    return name


def true_width_m(name: str) -> float | None:
    """Length of the seeded defect of a test recording along its race, m; None where there is none or it is unknown."""
    arc = next((degrees for key, degrees in ARCS_DEG.items() if f"_{key}_" in name), None)
    if arc is None:
        return WIDTHS_M.get(name)
    radius = (PITCH_M + BALL_M) / 2 if "_OR" in name else (PITCH_M - BALL_M) / 2
    return math.radians(arc) * radius


def judged(rig: str, condition: str, report: Document | None, error: str | None) -> str:
    """`right`, `undecided` (the truth is one of several), `refused` (for its clock) or `wrong`."""
    if report is None:
        return "refused" if "stamps are irregular" in (error or "") else "wrong"
    truth = TERMS.get(condition)
    if truth is None:
        return "right" if report["verdict"] == "nothing_missing" else "wrong"
    sites = {c["site"] for c in report["causes"] if c["term"] in truth}
    if not sites or SITES.get(rig, next(iter(sites))) not in sites:
        return "wrong"
    return "right" if report["verdict"] == "explained" else "undecided"


WHY = {
    "cwru_1797rpm_ball_007in": "Ball faults of this set seldom show a clean line, as the source says too; the lines of "
    "the outer race rose a little, which a damaged ball makes as well.",
    "B_1000_1": "No clean line of any part; lines of both races rose together and stay shallow, which is why the ball "
    "stands first, but nothing in the record excludes a race.",
    "b30hz50": "In broad bands sensor a1 lost level, lines and noise alike, while the other three kept theirs: that is "
    "a change of the path to a1, and by the catalogue the sidebands of the broken tooth show almost only there.",
    "b30hz80": "As at 50 % load: only the path to a1 changed by more than load changes it.",
    "Motor1_DamagedBearing_SevereHi-Fi_02_7cm_30Hz": "No bearing size is known of this motor, and a microphone hears "
    "impacts once a turn: a rub or a loose part make the same as a damaged bearing, which is the last of the set.",
    "Motor1_UnbalancedRotor_2Weights_Yaxis_30Hz": "The clock of the phone repeats and skips; orders of such a record "
    "mean nothing.",
    "dataBenchmark": "A tank is no mass on a spring: the ceiling of its level is named, but of some 400 samples with a "
    "red error chance explains as much as the laws that are tried, a square root among them, do.",
}
"""Why a row is wrong or undecided, by its test recording."""
