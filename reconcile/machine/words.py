"""Sentences a maintenance engineer can read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.machine.decide import AT_ONE, LINES_QUIET, OFTEN, UNMEASURED, Decision
from reconcile.machine.next_look import Apart, Look, best_look
from reconcile.machine.proved import NO_BETTER, NO_FORECAST, NO_NEARER, UNLIKE
from reconcile.observe.observation import PointData
from reconcile.report.words import percent, sizes
from reconcile.verdict import NO_GAIN, EstimatedForce, HeldOut, NextExperiment, Severity, operating_point
from sim.terms import REGISTRY

LISTED = 4
"""Effects that a sentence lists."""


def title(label: str) -> str:
    """`Outer-race spall at bearing1`."""
    key, site = label.split("@")
    term = REGISTRY.get(key)
    return f"{term.title if term else key} at {site}"


def size(severity: Severity | None) -> str:
    """`, width 1 mm (90 %: 0.9 mm to 1.1 mm)`, or nothing."""
    if severity is None:
        return ""
    value, low, high = sizes(severity)
    return f", {severity.name} {value} (90 %: {low} to {high})"


SEARCHED = "the two sizes it is forecast with were searched with all points, these too"


def with_points(held: HeldOut, data: Sequence[PointData], *, searched: bool = False) -> HeldOut:
    """The same with the operating points that were held out said by name; `searched`: sizes that were not held out."""
    points = ", ".join(operating_point(d.point.speed_hz, d.point.torque_ratio) for d in data)
    return replace(held, held=f"{held.held}: {points}{f' ({SEARCHED})' if searched else ''}")


def law_sentence(force: EstimatedForce, *, tried: bool) -> str:
    """What stage 6 found."""
    if force.law is None:
        laws = "no force law that was tried brings it about" if tried else "the full budget tries force laws there"
        return f"Of the supports {force.site} is the likeliest place; {laws}."
    return f"A force at {force.site} brings it about: {force.law}."


def more(shows: str, others: Sequence[str]) -> str:
    """` Impacts come from another part too: outer-race spall at bearing3, or outer-race spall at bearing4.`, or
    nothing where there are none."""
    if not others:
        return ""
    listed = ", or ".join(title(one).lower() for one in others[:LISTED])
    rest = "" if len(others) <= LISTED else f", or one of {len(others) - LISTED} more"
    return f" {shows[0].upper()}{shows[1:]}: {listed}{rest}."


def together(held: HeldOut) -> str:
    """What two effects do."""
    if held.gain <= 0.0:
        return "Together they bring the spectra no nearer on data not fitted."
    return f"Together they take {percent(held.gain)} off the distance of spectra on data not fitted."


def _gain(held: HeldOut) -> str:
    if held.gain <= 0.0:
        return NO_GAIN
    return f"; it takes {percent(held.gain)} off the distance of spectra on data it was not fitted to"


def _chance(p: float) -> str:
    return "< 0.001" if p < 0.001 else f"= {p:.2g}"


def sentence(decision: Decision, severity: Severity | None, held: HeldOut | None) -> str:
    """The verdict in one sentence."""
    if decision.word == "nothing_missing":
        return f"Nothing is missing: {decision.reasons[0]}."
    if decision.word == "explained":
        gain = "" if held is None else _gain(held)
        return f"{title(decision.chosen[0])}{size(severity)}{gain}."
    if decision.word == "unknown_physics":
        return f"Something is missing that no known effect explains: {decision.reasons[0]}."
    return _undecided(decision)


def _undecided(decision: Decision) -> str:
    """Of a set, or of a change of which nothing can be named."""
    best, unusual = title(decision.chosen[0]).lower(), f"(p {_chance(decision.p)})"
    if decision.reasons[0] in (NO_BETTER, NO_FORECAST, NO_NEARER, UNLIKE):
        return f"The change is unusual {unusual}, but {decision.reasons[0]} ({best}): nothing is named."
    if decision.reasons[0] == LINES_QUIET:
        told = f"the change is unusual {unusual}, but {LINES_QUIET}"
        return f"Whether anything is missing is not decided: {told}; nearest is {best}."
    if decision.reasons[0].startswith((AT_ONE, OFTEN)):
        told = f"the change is unusual {unusual}, but {decision.reasons[0]}"
        return f"Whether anything is missing is not decided: {told}; nearest is {best}."
    if decision.reasons[0] == UNMEASURED:
        return (
            f"The recordings differ from machines of this kind {unusual} in a way that no known effect "
            f"explains, but {UNMEASURED}; nearest is {best}."
        )
    listed = ", or ".join(title(c).lower() for c in decision.chosen[:LISTED])
    rest = "" if len(decision.chosen) <= LISTED else f" and {len(decision.chosen) - LISTED} more"
    return f"Something is missing {unusual}, but {decision.reasons[0]}: {listed}{rest}."


TEETH = frozenset(("missing_tooth", "tooth_spall"))
APART = {
    frozenset(("bent_shaft", "unbalance")): "A proximity probe on the shaft, at a slow roll and again at speed, would "
    "tell these effects apart best: a bow shows at a slow roll, an unbalance does not, and below the critical speed "
    "accelerometers at the bearings hear both alike.",
    TEETH: "No recording tells these two apart for sure, whatever their scores: a pit of most of a flank carries as "
    "little as a tooth that is gone. Open the gearbox and look at the teeth.",
}
"""What tells effects apart that more of the same recordings do not."""
DECIDES = 3.0
"""Log evidence (20 times as likely) from which a recording decides by itself what a sensor more would."""
UNKNOWN_THERE = "how much is not known, as no sensor there was simulated"
UNKNOWN_HOW_MUCH = "how much is not known"


def next_experiment(
    chosen: Sequence[str], lead: float, points: int, sensors: Sequence[str], apart: Apart | None = None
) -> NextExperiment | None:
    """What would tell the leading candidates apart. `lead`: log evidence of the first over the second; `points`:
    operating points; `sensors`: the parts they are at; `apart`: what the recordings tell between the two, were the
    first there. Without it, and of a sensor where nothing was simulated, no separation is expected."""
    if len(chosen) < 2:
        return None
    sites = list(dict.fromkeys(c.split("@")[1] for c in chosen))
    missing = [s for s in sites if s not in sensors and _unheard(s, apart)] if len(sites) > 1 else []
    alike = _never_apart(chosen)
    if alike is not None:
        return NextExperiment(sentence=alike, separation_now=lead)
    look = None if apart is None else best_look(apart)
    near = list(dict.fromkeys(b for s in missing[:2] for b in _unheard(s, apart)))
    place = f"the {'bearing housing nearest to' if near == missing[:2] else 'housing of'} {' or '.join(near)}"
    if missing and (look is None or apart is None or not _decides(look, lead)):
        best = "" if look is None or apart is None else _of_those_at_hand(look, apart)
        text = f"An accelerometer on {place} is most likely to tell these places apart; {UNKNOWN_THERE}.{best}"
        return NextExperiment(sentence=text, separation_now=lead)
    if look is None or apart is None:
        more = "one more" if points > 1 else "a second"
        text = f"A recording at {more} speed or load may tell these effects apart; {UNKNOWN_HOW_MUCH}."
        return NextExperiment(sentence=text, separation_now=lead)
    sensor = f" An accelerometer on {place} may tell more; {UNKNOWN_THERE}." if missing else ""
    text = f"{_recording(look, apart)}{sensor}"
    return NextExperiment(sentence=text, separation_now=lead, separation_expected=lead + look.adds)


def _never_apart(chosen: Sequence[str]) -> str | None:
    """What tells effects apart that recordings do not, if there are such; teeth are alike on one gear only."""
    terms = {c.split("@")[0] for c in chosen}
    gears = {c.split("@")[1] for c in chosen}
    tooth = any({f"{term}@{gear}" for term in TEETH} <= set(chosen) for gear in gears)
    return next((text for both, text in APART.items() if both <= terms and (both != TEETH or tooth)), None)


def _unheard(site: str, apart: Apart | None) -> tuple[str, ...]:
    """Where a sensor would hear a place that none at hand is near to: itself, or bearings on its shaft."""
    return apart.unheard.get(site, (site,)) if apart is not None else (site,)


def _decides(look: Look, lead: float) -> bool:
    return look.kind != "nothing" and lead + look.adds >= DECIDES


def _recording(look: Look, apart: Apart) -> str:
    """The advice of a further recording."""
    if look.kind == "nothing":
        return (
            "More of the same recordings would not tell the first two of these effects apart: simulated, they look "
            "alike at every speed and sensor recorded. Look at the parts themselves, or record at quite another speed."
        )
    most = f", above all on {apart.loudest}" if len(apart.channels) > 1 else ""
    if look.kind == "point":
        return (
            f"A further recording at about {look.place} would tell these effects apart best: there the first two "
            f"differ most{most}."
        )
    advice = "Recordings twice as long" if look.kind == "longer" else "A recording at one more speed or load"
    return f"{advice} would tell these effects apart best{most}."


def _of_those_at_hand(look: Look, apart: Apart) -> str:
    """What the sensors at hand tell of the places."""
    if look.kind == "nothing":
        return " The sensors at hand are not expected to: simulated, the first two look alike there at every speed."
    return f" Of the sensors at hand {apart.loudest} tells them apart best." if len(apart.channels) > 1 else ""
