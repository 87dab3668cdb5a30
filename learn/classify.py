"""A recording's class by a trained model: speed, geometry, answer and what speaks for it, as one document."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np

from learn.assess import Assessment, answered, check_heads, estimated
from learn.describe import Site
from learn.elsewhere import Elsewhere, elsewhere, known_to
from learn.gears.assess import StageAnswer, assess_stage, knows_gears
from learn.gears.stage import Stage
from learn.heard import check_rate
from learn.looked import Looked
from learn.measured import measured
from learn.model import Model
from learn.remarks import FOREIGN, check_learnt, of_parts, of_sites, of_speed
from learn.speed import Speed
from learn.tacho import Pulses, pulses_of
from reconcile.stated import check_speeds, given
from signals.recording import Recording
from sim.core.errors import Problem, SpecError

PART = ("bearing", "stage", "gear", "label", "probabilities")
MOST_REMARKS = 20
PER_NEPER_DB = float(10 / np.log(10))
"""Decibels in a natural logarithm of powers."""
SYMBOLS = {"outer": "BPFO", "inner": "BPFI", "ball": "2 BSF", "cage": "4 FTF"}


def speed_of(recording: Recording, sites: Sequence[Site], pulses: Pulses, *, trust: bool) -> Speed:
    """Pulses all along; the stated speed where it is to be trusted; else what the lines say, near the pulses' speed
    where these cover only a part, or the stated one."""
    if pulses.firm and pulses.speed_hz is not None:
        return Speed(speed_hz=pulses.speed_hz, method="tacho", standing=np.inf)
    stated = recording.operating.speed_hz if recording.operating is not None else None
    if not trust and stated is not None:
        check_learnt(stated)
    if trust:
        if stated is None or stated <= 0:
            raise SpecError(
                Problem(field="operating.speed_hz", message="is needed to be trusted", given=stated, unit="Hz")
            )
        return Speed(speed_hz=stated, method="given", standing=0.0)
    orders = sites[0].orders if sites and sites[0].ratio == 1.0 else None
    start = pulses.speed_hz if pulses.used else stated
    return estimated(list(recording.samples), recording.sampling_rate_hz, start or None, orders)


@contextmanager
def _said_by(pulses: Pulses) -> Iterator[None]:
    """A refusal that may be the pulses' fault says what is wrong with these."""
    try:
        yield
    except SpecError as error:
        said = [Problem(field="tacho", message=remark.removeprefix("tacho: ")) for remark in pulses.remarks]
        raise SpecError([*error.problems, *said]) from None


def classify(
    recording: Recording,
    model: Model,
    sites: Sequence[Site] = (),
    *,
    stages: Sequence[Stage] = (),
    channels: Sequence[str] | None = None,
    trust_speed: bool = False,
) -> dict[str, Any]:
    """Label, probabilities, speed, and what was found, of the part that is least likely sound; `parts` has them all.

    Bearings and gear stages are looked at apart. Where only gears are described, no bearing is guessed at; a stage
    whose mesh or turns the recording does not hold is refused only if nothing else is there to answer for.
    """
    check_speeds({}, "", given([recording], []))
    remarks: list[str] = []
    if stages and not knows_gears(model):
        stages, remarks = (), ["gears: are not looked at, the model was not trained on any"]
    heard = measured(recording, channels)
    chosen = heard.recording
    pulses = pulses_of(chosen, trust=trust_speed)
    with _said_by(pulses):
        speed = speed_of(chosen, sites, pulses, trust=trust_speed)
    parts = []
    if sites or not stages:
        check_heads(model, known=bool(sites))
        remarks += check_rate(chosen.sampling_rate_hz, speed.speed_hz, sites)
        with _said_by(pulses):
            parts = _bearings(chosen, model, sites, stages, speed)
    unseen: list[SpecError] = []
    for stage in stages:
        try:
            parts.append(_gears(chosen, model, stage, speed))
        except SpecError as error:
            unseen.append(error)
            remarks.append(f"{stage.name}: is not looked at: {error}")
    if not parts:
        raise unseen[0]
    first = min(parts, key=lambda part: part["probabilities"].get("healthy", 1.0))
    shown = ("label", "probabilities", "bearing", "stage", "gear", "geometry", "severity_index", "turns", "stretches")
    return {
        **{name: first[name] for name in shown},
        "speed": {
            "speed_hz": speed.speed_hz,
            "method": speed.method,
            "estimated": speed.method not in ("tacho", "given"),
        },
        "channels": list(chosen.names),
        "lines": first["lines"],
        "parts": [{name: part[name] for name in PART} for part in parts],
        "remarks": [
            *heard.remarks(),
            *remarks,
            *pulses.remarks,
            *of_speed(chosen, speed, sites[0].ratio if sites else 1.0),
            *of_sites(sites),
            *of_parts(parts),
        ][:MOST_REMARKS],
        "measurement_faults": [*heard.faults(), *pulses.faults()],
    }


def _bearings(
    chosen: Recording, model: Model, sites: Sequence[Site], stages: Sequence[Stage], speed: Speed
) -> list[dict[str, Any]]:
    """Each bearing that is described, or any usual one."""
    found = []
    for site in sites or (None,):
        ratio = site.ratio if site is not None else 1.0
        seen = Looked(
            channels=tuple(chosen.samples),
            rate_hz=chosen.sampling_rate_hz,
            speed_hz=speed.speed_hz * ratio,
            orders=site.orders if site is not None else None,
            doubt=speed.doubt,
        )
        answer = answered(seen, model, [f * ratio for f in speed.likely])
        foreign = elsewhere(seen.long, *known_to(site, sites, stages)) if site is not None else None
        found.append(
            {
                "label": answer.label,
                "probabilities": answer.probabilities,
                "bearing": site.name if site is not None else None,
                "stage": None,
                "gear": None,
                "geometry": answer.geometry,
                "severity_index": answer.severity,
                "turns": answer.turns,
                "stretches": answer.stretches,
                "lines": [*_lines(answer, seen.speed_hz, chosen.names), *_foreign(foreign, seen.speed_hz)],
            }
        )
    return found


def _foreign(found: Elsewhere | None, speed_hz: float) -> list[dict[str, Any]]:
    """Impacts of no part of the bearing, as one more line."""
    if found is None:
        return []
    hz = found.order * speed_hz
    return [{"family": FOREIGN, "order": found.order, "frequency_hz": hz, "z": found.z, "depth": found.depth}]


def _gears(chosen: Recording, model: Model, stage: Stage, speed: Speed) -> dict[str, Any]:
    """A stage; `gear` is named where a tooth is damaged."""
    hz = speed.speed_hz * stage.ratio
    answer = assess_stage(list(chosen.samples), chosen.sampling_rate_hz, hz, model, stage.teeth, speed.doubt)
    return {
        "label": answer.label,
        "probabilities": answer.probabilities,
        "bearing": None,
        "stage": stage.name,
        "gear": stage.gears[answer.gear] if answer.label != "healthy" else None,
        "geometry": "known",
        "severity_index": None,
        "turns": answer.turns,
        "stretches": answer.parts,
        "lines": _peak(answer, stage, chosen.names),
    }


def _peak(answer: StageAnswer, stage: Stage, names: Sequence[str]) -> list[dict[str, Any]]:
    """The place of a turn that stands out most, as the one line: its order is a turn of that gear."""
    if answer.place is None:
        return []
    ratio = 1.0 if answer.gear == 0 else stage.teeth[0] / stage.teeth[1]
    order = stage.ratio * ratio
    return [
        {
            "family": stage.gears[answer.gear],
            "order": order,
            "frequency_hz": answer.speed_hz * ratio,
            "peak_over_mean_db": PER_NEPER_DB * answer.place.peak,
            "peak_over_next_db": PER_NEPER_DB * answer.place.alone,
            "band": answer.place.band,
            "channel": names[answer.place.channel],
        }
    ]


def _lines(answer: Assessment, speed_hz: float, names: Sequence[str]) -> list[dict[str, Any]]:
    """What was found of each family, the clearest first."""
    if answer.geometry == "unknown":
        order = answer.comb["order"]
        return [{"family": "unknown", "order": order, "frequency_hz": order * speed_hz, "z": answer.comb["z"]}]
    return [
        {
            "family": SYMBOLS[f.family],
            "order": f.order,
            "frequency_hz": f.order * speed_hz,
            "slip": f.slip,
            "z": f.z,
            "chance": 10.0**-f.chance,
            "depth": f.depth,
            "band_hz": list(f.band_hz),
            "channel": names[f.channel],
        }
        for f in sorted(answer.found.values(), key=lambda f: -f.z)
        if f.searched
    ]
