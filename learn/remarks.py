"""What an answer does not say by itself: where the speed came from, how sure a label is, what it rests on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from learn.describe import Site
from learn.features import HIGHEST_BASE as TOP
from learn.speed import HIGHEST_HZ, LOWEST_HZ, Speed
from reconcile.stated import FAST_HZ
from signals.recording import Recording
from sim.core.errors import Problem, SpecError
from sim.parts.bearing.catalogue import CatalogueRow, lookup

UNSURE = 0.7
"""Probability below which a measured recording is to be looked at again (docs/sim2real.md)."""
PLAIN = 3.0
"""Deviations over other orders from which lines of a family stand out at a look."""
OWN = {"outer": ("BPFO",), "inner": ("BPFI",), "ball": ("2 BSF", "4 FTF")}
"""Families of lines that a label's fault makes."""
FOREIGN = "foreign"
"""Family of lines that are of no part of the bearing (`learn.elsewhere`)."""
PER_MINUTE = 60.0
SLOWEST_HZ = 1.0
"""Speed that a number of revolutions per minute is asked to be."""


def check_learnt(stated_hz: float) -> None:
    """SpecError for a stated speed that is far above those learnt from and would be one of them as rpm: an answer
    would say nothing. One that is to be trusted (`--trust-speed`), or that pulses tell, is not asked."""
    per_second = stated_hz / PER_MINUTE
    if stated_hz > FAST_HZ and LOWEST_HZ <= per_second <= HIGHEST_HZ:
        message = (
            f"is far above the speeds learnt from; is it in revolutions per minute? Then state {per_second:.4g} Hz"
        )
        allowed = f"{LOWEST_HZ:g} to {HIGHEST_HZ:g} Hz, or --trust-speed"
        raise SpecError(Problem(field="operating.speed_hz", message=message, given=stated_hz, allowed=allowed))


def of_speed(recording: Recording, speed: Speed, ratio: float = 1.0) -> list[str]:
    """How the speed is known, where it is not by pulses or lines; and whether shafts of it were among the examples."""
    stated = recording.operating.speed_hz if recording.operating is not None else None
    said = []
    if speed.method == "stated":
        said.append(f"speed: no line confirms {speed.speed_hz:.4g} Hz, which is taken as stated; a wrong one misleads")
    if speed.method == "scan":
        said.append(
            f"speed: none is stated; {speed.speed_hz:.4g} Hz was chosen among {LOWEST_HZ:g} to {HIGHEST_HZ:g} Hz, "
            "which often errs"
        )
    turning = speed.speed_hz * ratio
    if not LOWEST_HZ <= turning <= HIGHEST_HZ:
        told = f"speed: {turning:.4g} Hz is not among those learnt from ({LOWEST_HZ:g} to {HIGHEST_HZ:g} Hz)"
        per_second = (stated or 0.0) / PER_MINUTE
        rpm = f"; as revolutions per minute it would be {per_second:.4g} Hz"
        said.append(told + (rpm if turning > HIGHEST_HZ and SLOWEST_HZ <= per_second <= HIGHEST_HZ else ""))
    return said


def of_sites(sites: Iterable[Site]) -> list[str]:
    """Bearings unlike those learnt from: an outer ring that turns, lines beyond what is searched."""
    said = []
    for site in sites:
        o = site.orders
        if site.alike:
            said.append(f"{site.name}: {', '.join(site.alike)} has the same orders: what is said may be of either")
        if site.catalogued is not None:
            said.append(_of_catalogue(site.name, lookup(site.catalogued)))
        if o.cage > 0.5:
            said.append(
                f"{site.name}: its cage's order says that the outer ring turns; inner rings' turning was learnt"
            )
        beyond = [name for name, order in (("BPFO", o.outer), ("BPFI", o.inner), ("2 BSF", o.ball)) if order > TOP]
        if beyond:
            said.append(f"{site.name}: {', '.join(beyond)} above order {TOP:g}: not looked for")
    return said


def _of_catalogue(name: str, row: CatalogueRow) -> str:
    """Makers fill one size differently: whose bearing was meant."""
    inferred = ", sizes inferred from its printed orders" if row.basis == "inferred" else ""
    return (
        f"{name}: {row.designation} is taken as {row.maker}'s, {row.balls} {row.element}s{inferred}; others may differ"
    )


PROPER = {"outer": "BPFO", "inner": "BPFI", "ball": "2 BSF"}
"""The line that a defect makes by itself; a cage's order may lie at a half of another shaft's turn."""


def of_parts(parts: Iterable[Mapping[str, Any]]) -> list[str]:
    """How far each part's answer carries."""
    parts, said = list(parts), []
    knocking = next(
        (p for p in parts if p["stage"] is not None and p["probabilities"].get("tooth", 0.0) >= UNSURE), None
    )
    for part in parts:
        where = part["bearing"] or part["stage"] or "bearing"
        label, chance = part["label"], part["probabilities"][part["label"]]
        if part["stage"] is not None:
            said.append(f"{where}: of stages too little is known by measurement to rely on this (docs/sim2real.md)")
        elif part["geometry"] == "unknown":
            said.append(f"{where}: its size is not known; answers are much less often right than with it")
        if chance < UNSURE or (label == "ball" and part["stage"] is None):
            why = "balls are the least sure" if label == "ball" else f"{chance:.2f} is below {UNSURE:g}"
            said.append(f"{where}: look closer before acting on '{label}': {why}")
        said += [_of_foreign(where, label, line) for line in part["lines"] if line["family"] == FOREIGN]
        if knocking is not None and part["stage"] is None and label != "healthy":
            said.append(_beside_a_tooth(where, label, part, knocking))
        own = [line["z"] for line in part["lines"] if line["family"] in OWN.get(label, ())]
        if own and max(own) < PLAIN:
            most = f"{max(own):.1f} deviations over other orders"
            said.append(f"{where}: '{label}' rests on no line that stands out ({most} at most): is this the bearing?")
    return said


def _beside_a_tooth(where: str, label: str, part: Mapping[str, Any], stage: Mapping[str, Any]) -> str:
    """What a bearing's name is worth where a tooth knocks."""
    tooth = f"the damaged tooth at {stage.get('gear') or stage['stage']}"
    proper = [line["z"] for line in part["lines"] if line["family"] == PROPER.get(label)]
    if proper and max(proper) >= PLAIN:
        return f"{where}: '{label}' stands beside {tooth}, whose knocks every envelope has: mend that, and record again"
    return (
        f"{where}: do not act on '{label}': its own line stands out nowhere, and the knocks of {tooth} are in every "
        "envelope; mend that, and record again"
    )


def _of_foreign(where: str, label: str, line: Mapping[str, Any]) -> str:
    also = ", and 'healthy' is of the stated bearing alone" if label == "healthy" else ""
    return (
        f"{where}: clear impacts at order {line['order']:.3g} ({line['frequency_hz']:.3g} Hz) are of no part of it: "
        f"they are another part's, or the bearing is not the one stated{also}"
    )
