"""What a report says beyond its verdict, as short texts: place, size, path, what is left, held-out data."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

Document = Mapping[str, Any]
KINDS = {"outer_spall": "outer", "inner_spall": "inner", "ball_spall": "ball"}
NOT_EXPLAINED = "not explained by the defect: "
MOST_CAUSES = 4
PRECISE, FAR = 0.1, 10.0
"""Errors (share of the spread) below which decimals are shown, and from which on it is said in words."""


def causes(report: Document) -> str:
    """`outer spall of bearing`, or the set."""
    shown = [f"{c['term'].replace('_', ' ')} of {c['site']}" for c in report["causes"][:MOST_CAUSES]]
    if not shown and report["fault"] is not None:
        return f"{report['fault']['kind'].replace('_', ' ')}: {report['fault']['channel']}"
    return (" or " if report["verdict"] == "ambiguous" else ", ").join(shown)


def places(report: Document) -> str:
    """Sites with their weights, and the channels that hear the cause, by how firmly (robust standard deviations)."""
    sites = ", ".join(f"{s['site']} ({s['weight']:.2f})" for s in report["where"]["sites"])
    if not sites and report["fault"] is not None:
        return f"sensor {report['fault']['channel']}"
    row = family(report)
    heard = row.get("heard", {}) if row else {}
    if len(heard) < 2:
        return sites
    return f"{sites}; " + ", ".join(f"{name} {z:.0f}" for name, z in sorted(heard.items(), key=lambda h: -h[1]))


def family(report: Document) -> Document | None:
    """The family of lines that the first cause was judged by."""
    table: list[Document] = next((s["table"] for s in report["stages"] if s.get("name") == "families"), [])
    rows = {row["family"]: row for row in table if row["present"]}
    for c in report["causes"]:
        found = rows.get(f"{c['site']}.{KINDS.get(c['term'], 'turn')}")
        if found is not None and (found["risen"] or c["named"]):
            return dict(found)
    return None


def path(report: Document) -> str:
    """Band, channel and depth of the modulation, and where the level around it rose most."""
    row = family(report)
    said = []
    if row is not None:
        low, high = row["band_hz"]
        growth = "" if row["growth_db"] is None else f", {row['growth_db']:+.0f} dB"
        said.append(f"{low / 1e3:.2g} to {high / 1e3:.3g} kHz of {row['channel']}, depth {row['depth']:.2f}{growth}")
    said += [f"{channel} {change} dB around {float(hz) / 1e3:.2g} kHz" for channel, change, hz in _transfers(report)]
    return "; ".join(said)


def _transfers(report: Document) -> list[tuple[str, str, str]]:
    findings: list[str] = next((s["findings"] for s in report["stages"] if s.get("name") == "gate"), [])
    pattern = re.compile(r"all tests (\S+): loose_sensor, its transfer changed by up to (\S+) dB around (\S+) Hz")
    return [found.groups() for text in findings if (found := pattern.match(text))]  # type: ignore[misc]


def order(report: Document) -> str:
    """Order of the lines and how far it is from the drawing's."""
    row = family(report)
    slip = next((c["values"]["slip"] for c in report["causes"] if "slip" in c["values"]), None)
    if row is None:
        return ""
    return f"{row['order']:.3f}" + ("" if slip is None else f" ({slip:+.1%})")


def size(report: Document) -> str:
    """Length of the defect along its race in mm with its interval; what it grew from where the baseline has it."""
    grown = re.search(r"it grew from (.*) degrees", report["sentence"])
    before = f"; grew from {grown.group(1)} degrees" if grown else ""
    severity, below = first_size(report), first_bound_m(report)
    if severity is None:
        return f"below {1e3 * below:.1f} mm{before}" if below is not None else before.removeprefix("; ")
    value, low, high = (1e3 * severity[k] for k in ("value", "low", "high"))
    return f"{value:.1f} mm ({low:.1f} to {high:.1f}){before}"


def first_bound_m(report: Document) -> float | None:
    """The length that the defect of the first cause stays below, m, where no more is known of it."""
    return report["causes"][0]["values"].get("width_below_m") if report["causes"] else None


def first_size(report: Document) -> Document | None:
    """The size of the first cause, in m."""
    severity = report["causes"][0]["severity"] if report["causes"] else None
    return severity if severity is not None and severity["unit"] == "m" else None


def left(report: Document) -> str:
    """What changed besides and is said not to be the defect's."""
    return "; ".join(t.removeprefix(NOT_EXPLAINED) for t in report["undecidable"] if t.startswith(NOT_EXPLAINED))


def speeds(report: Document) -> dict[str, float]:
    """Speed found in each recording, Hz."""
    found: Document = next((s["found"] for s in report["stages"] if s.get("name") == "speed"), {})
    return {label: float(one["speed_hz"]) for label, one in found.items()}


def error(before: float, gain: float | None, unit: str) -> str:
    """Error of a rival on the held-out data, from its gain."""
    return "" if gain is None else amount(before * (1 - gain), unit)


def amount(value: float, unit: str) -> str:
    """An error in dB, or a share as per cent."""
    if unit == "dB":
        return f"{value:.1f}"
    if value >= FAR:
        return f"{value:.0f} times the spread"
    return f"{100 * value:.2g} %" if value < PRECISE else f"{100 * value:.0f} %"
