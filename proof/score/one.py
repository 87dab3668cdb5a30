"""The score of one case."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from proof.score.equivalence import FAULT_WORDS, same_unit

EFFECTS = ("single", "double", "open", "no_baseline")
QUIET = ("nothing_missing", "not_decidable")
PLACEBO_GAIN = 0.05
"""A placebo that improves the fit on held-out data by more than this share counts as improving."""
Json = Mapping[str, Any]


@dataclass(frozen=True, kw_only=True)
class Score:
    """What the engine got right. None: does not apply to the case; what was not detected is False, not None."""

    name: str
    group: str
    laws: tuple[str, ...]
    level: int
    sensors: int
    snr_db: float
    speeds: int
    baseline: bool
    verdict: str
    failed: bool
    verdict_right: bool
    alarm: bool
    mechanism: bool | None = None
    place: bool | None = None
    top_three: bool | None = None
    unknown_flagged: bool | None = None
    false_unknown: bool | None = None
    false_name: bool | None = None
    both: bool | None = None
    cannot_tell: bool | None = None
    fault_kind: bool | None = None
    fault_channel: bool | None = None
    severity_error: float | None = None
    severity_covered: bool | None = None
    gain: float | None = None
    gain_low: float | None = None
    ceiling: float | None = None
    beats_retuned: bool | None = None
    beats_black_box: bool | None = None
    placebo_improves: bool | None = None
    core_seconds: float | None = None
    told_unseen: bool | None = None
    """Of an effect that was not seen: whether the report says that it need not have been (`faintest`)."""


def score(truth: Json, report: Json | None) -> Score:
    """Score a report; None: the engine failed, which counts as wrong in everything that applies."""
    said = report or {"verdict": "failed"}
    verdict = str(said.get("verdict", "failed"))
    group = str(truth["group"])
    found: dict[str, Any] = {
        "name": truth["name"],
        "group": group,
        "laws": tuple(e["law"] for e in truth["effects"]),
        "level": truth["level"],
        "sensors": len(truth["sensors"]),
        "snr_db": truth["snr_db"],
        "speeds": len(truth["speeds_hz"]),
        "baseline": truth["baseline"],
        "verdict": verdict,
        "failed": report is None,
        "alarm": verdict not in (*QUIET, "failed"),
    }
    found |= _of_group(group)(truth, said, verdict)
    found |= _held_out(said)
    if found["group"] in EFFECTS and found.get("beats_black_box") is None:
        found["beats_black_box"] = False
    cost = ((said.get("provenance") or {}).get("cost") or {}).get("core_s")
    found["core_seconds"] = float(cost) if isinstance(cost, int | float) else None
    return Score(**found)


def _of_group(group: str) -> Any:  # noqa: ANN401  a table of functions
    table = {"null": _null, "misset": _null, "sensor": _sensor, "open": _open, "ambiguous": _ambiguous}
    return table.get(group, _effects)


def _null(_truth: Json, _said: Json, verdict: str) -> dict[str, Any]:
    return {"verdict_right": verdict == "nothing_missing"}


def _sensor(truth: Json, said: Json, verdict: str) -> dict[str, Any]:
    fault = said.get("fault") or {}
    kind = verdict == "measurement_fault" and fault.get("kind") in FAULT_WORDS[truth["fault"]]
    spoiled = [channel_name(truth["sensors"][truth["fault_channel"]])]
    if truth["fault"] == "swapped":
        spoiled.append(channel_name(truth["sensors"][(truth["fault_channel"] + 1) % len(truth["sensors"])]))
    named = str(fault.get("channel", ""))
    return {
        "verdict_right": verdict == "measurement_fault",
        "fault_kind": kind,
        "fault_channel": kind and any(name in named for name in spoiled),
    }


def channel_name(sensor: str) -> str:
    """Name of the channel at `bearingJ.axis` in the recordings."""
    where, axis = sensor.split(".")
    return f"resonator{where[7:]}.y.acceleration" if axis == "y" else f"{where}.outer.x.acceleration"


def _open(truth: Json, said: Json, verdict: str) -> dict[str, Any]:
    site = truth["effects"][0]["site"]
    places = (said.get("where") or {}).get("sites") or []
    best: Json = max(places, key=lambda p: float(p.get("weight", 0.0)), default={})
    flagged = verdict == "unknown_physics"
    return {"verdict_right": flagged, "unknown_flagged": flagged, "place": flagged and best.get("site") == site}


def _ambiguous(truth: Json, said: Json, verdict: str) -> dict[str, Any]:
    listed = {(c.get("term"), c.get("site")) for c in answer(said)}
    alike = {tuple(c) for c in truth["causes"]}
    one = len(listed) == 1
    told = verdict == "ambiguous" and len(listed & alike) >= 2
    cannot = told or verdict == "not_decidable" or (verdict == "ambiguous" and not one and bool(listed & alike))
    return {"verdict_right": cannot, "cannot_tell": cannot}


def answer(said: Json) -> list[Json]:
    """The causes the report stands behind: the named ones; of a set all members; else the first."""
    causes = list(said.get("causes") or [])
    named = [c for c in causes if c.get("named")]
    if named:
        return named
    if said.get("verdict") == "ambiguous":
        return causes[:6]
    return causes[:1] if said.get("verdict") == "explained" else []


def _is(cause: Json, effect: Json, *, place: bool) -> bool:
    return cause.get("term") in effect["terms"] and (not place or cause.get("site") in effect["sites"])


def _effects(truth: Json, said: Json, verdict: str) -> dict[str, Any]:
    effects: Sequence[Json] = truth["effects"]
    stands = answer(said)
    ranked = list(said.get("causes") or [])
    alarmed = verdict not in (*QUIET, "failed", "measurement_fault")
    mechanism = [any(_is(c, e, place=False) for c in stands) for e in effects]
    place = [any(_is(c, e, place=True) for c in stands) for e in effects]
    other = not all(any(_is(c, e, place=False) for e in effects) for c in stands)
    false = not all(any(_is(c, e, place=True) for e in effects) for c in stands)
    found: dict[str, Any] = {
        "verdict_right": (verdict == "explained" and not false) or (verdict == "ambiguous" and all(place)),
        "false_name": verdict == "explained" and false,
        "alarm": alarmed,
        "mechanism": all(mechanism) and not other and verdict != "ambiguous",
        "place": all(place) and not false and verdict != "ambiguous",
        "top_three": alarmed and any(_is(c, e, place=True) for c in ranked[:3] for e in effects),
        "false_unknown": verdict == "unknown_physics",
    }
    if verdict == "nothing_missing" and len(effects) == 1:
        found["told_unseen"] = _told_unseen(effects[0], list(said.get("faintest") or []))
    if len(effects) > 1:
        found["both"] = found["place"]
    elif place[0]:
        found |= _severity(effects[0], next(c for c in stands if _is(c, effects[0], place=True)))
    return found


def _told_unseen(effect: Json, told: Sequence[Json]) -> bool | None:
    """None where the effect's size is not in the report's terms, or nothing is said of it."""
    rows = [row for row in told if _is(row, effect, place=True)]
    if not rows or not effect["severity"]["sized"]:
        return None
    true = float(effect["severity"]["value"])
    smallest = [
        same_unit(str(r["term"]), str(r["site"]), str(r["name"]), float(r["seen_from"])) for r in rows if r["seen_from"]
    ]
    return not smallest or true < min(smallest)


def _severity(effect: Json, cause: Json) -> dict[str, Any]:
    told = cause.get("severity")
    if not told or not effect["severity"]["sized"]:
        return {}
    term, site, name = str(cause["term"]), str(cause["site"]), str(told["name"])
    true = float(effect["severity"]["value"])
    value, low, high = (same_unit(term, site, name, float(told[key])) for key in ("value", "low", "high"))
    return {"severity_error": abs(value - true) / abs(true), "severity_covered": low <= true <= high}


def _held_out(said: Json) -> dict[str, Any]:
    held = said.get("held_out")
    if not held or held.get("gain") is None:
        return {}
    gain = float(held["gain"])
    rivals = {key: held.get(key) for key in ("retuned", "black_box", "placebo")}
    return {
        "gain": gain,
        "gain_low": held.get("gain_low"),
        "ceiling": held.get("ceiling"),
        "beats_retuned": None if rivals["retuned"] is None else gain > float(rivals["retuned"]),
        "beats_black_box": None if rivals["black_box"] is None else gain > float(rivals["black_box"]),
        "placebo_improves": None if rivals["placebo"] is None else float(rivals["placebo"]) > PLACEBO_GAIN,
    }
