"""Recordings that tell no speed in any way, and with which one they were read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reconcile.stated import Given
from reconcile.verdict import Report

NAMES = {"recording": "test", "baseline": "baseline"}


def unstated(several: Sequence[Given], report: Report) -> tuple[str, ...]:
    """What the report says of them: the speed that it found by lines of the shaft, else the machine file's."""
    silent = [
        f"{NAMES[one.kind]} {one.index + 1}"
        for one in several
        if one.recording.operating is None and one.recording.tacho is None
    ]
    found = _by_lines(report)
    taken = [label for label in silent if label not in found]
    says = "state no speed" if len(taken) > 1 else "states no speed"
    return (
        *(
            f"{label} states no speed: the machine file's was the start, lines of the shaft were found at "
            f"{found[label]:.4g} Hz"
            for label in silent
            if label in found
        ),
        *((f"{', '.join(taken)} {says}: the machine file's was taken",) if taken else ()),
    )


def _by_lines(report: Report) -> dict[str, float]:
    """Speed, Hz, of each recording whose lines told it."""
    found = next((s.get("found") for s in report.stages if s.get("name") == "speed"), None)
    rows = found if isinstance(found, Mapping) else {}
    return {label: row["speed_hz"] for label, row in rows.items() if row["method"] == "harmonics"}
