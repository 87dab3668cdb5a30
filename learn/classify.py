"""A recording's class by a trained model: speed, geometry, answer and what speaks for it, as one document."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from learn.assess import Assessment, assess, estimated
from learn.describe import Site
from learn.model import Model
from learn.speed import Speed, by_pulses
from signals.checks import inspect
from signals.recording import Recording
from sim.core.errors import Problem, SpecError

VIBRATION = ("acceleration", "velocity", "displacement", "sound pressure")
SYMBOLS = {"outer": "BPFO", "inner": "BPFI", "ball": "2 BSF", "cage": "4 FTF"}


def usable(recording: Recording, channels: Sequence[str] | None = None) -> Recording:
    """The recording's vibration channels, or those named; SpecError where none is left or samples are not finite."""
    names = list(channels) if channels else [c.name for c in recording.channels if c.quantity in VIBRATION]
    if not names:
        known = ", ".join(f"{c.name} ({c.quantity or '-'})" for c in recording.channels)
        raise SpecError(
            Problem(field="channels", message="hold no vibration", given=known, allowed=", ".join(VIBRATION))
        )
    chosen = recording.select(channels=names)
    for row, name in enumerate(names):
        values = chosen.samples[row]
        if not np.all(np.isfinite(values)):
            raise SpecError(Problem(field=f"channels.{name}", message="has samples that are not finite"))
        if float(np.ptp(values)) == 0.0:
            raise SpecError(Problem(field=f"channels.{name}", message="is constant: nothing was measured"))
    return chosen


def speed_of(recording: Recording, sites: Sequence[Site], *, trust: bool) -> Speed:
    """Pulses; the stated speed where it is to be trusted; else what the lines say."""
    pulses = by_pulses(recording)
    if pulses is not None:
        return pulses
    stated = recording.operating.speed_hz if recording.operating is not None else None
    if trust:
        if stated is None or stated <= 0:
            raise SpecError(
                Problem(field="operating.speed_hz", message="is needed to be trusted", given=stated, unit="Hz")
            )
        return Speed(speed_hz=stated, method="given", standing=0.0)
    orders = sites[0].orders if sites and sites[0].ratio == 1.0 else None
    return estimated(list(recording.samples), recording.sampling_rate_hz, stated or None, orders)


def classify(
    recording: Recording,
    model: Model,
    sites: Sequence[Site] = (),
    *,
    channels: Sequence[str] | None = None,
    trust_speed: bool = False,
) -> dict[str, Any]:
    """Label, probabilities, speed, and the lines found; of several bearings the one that is least likely sound."""
    chosen = usable(recording, channels)
    speed = speed_of(chosen, sites, trust=trust_speed)
    rows = list(chosen.samples)
    answers: list[tuple[str, float, Assessment]] = []
    for site in sites or (None,):
        ratio = site.ratio if site is not None else 1.0
        orders = site.orders if site is not None else None
        likely = [f * ratio for f in speed.likely]
        answer = assess(rows, chosen.sampling_rate_hz, speed.speed_hz * ratio, model, orders, speed.doubt, likely)
        answers.append((site.name if site is not None else "", ratio, answer))
    name, ratio, answer = min(answers, key=lambda a: a[2].probabilities.get("healthy", 1.0))
    return {
        "label": answer.label,
        "probabilities": answer.probabilities,
        "bearing": name or None,
        "geometry": answer.geometry,
        "speed": {
            "speed_hz": speed.speed_hz,
            "method": speed.method,
            "estimated": speed.method not in ("tacho", "given"),
        },
        "severity_index": answer.severity,
        "turns": answer.turns,
        "stretches": answer.stretches,
        "channels": list(chosen.names),
        "lines": _lines(answer, speed.speed_hz * ratio, chosen.names),
        "remarks": [f"{f.channel}: {f.kind}: {f.message}" for f in inspect(chosen)][:20],
    }


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
    ]
