"""What a measurement chain can be made of, as a document: kinds of channels, their stages, ready sensors."""

from __future__ import annotations

from typing import get_args

from signals.sensors import PRESETS, SensorChain
from signals.sensors.spec import AnalogueChannel, Tacho
from sim.core.errors import UnknownName

KINDS = (*get_args(AnalogueChannel), Tacho)
NO_STAGES = ("kind", "name", "preset", "output")
"""Fields of a channel that are no stage of it."""
LAST = ("sensor", "probe", "noise", "hum", "drift", "anti_alias", "converter", "dropouts")
"""Stages that follow the place, path and mounting of a channel, in the order in which they act."""


def sensor_document() -> dict[str, object]:
    """Kinds, presets, and the JSON Schema of the key `sensors` of a simulation."""
    return {
        "kinds": [_kind(kind) for kind in KINDS],
        "presets": [sensor_preset(name) for name in PRESETS],
        "schema": SensorChain.model_json_schema(),
    }


def sensor_preset(name: str) -> dict[str, object]:
    """A sensor by name, with the stages it fills in; raises UnknownName."""
    if name not in PRESETS:
        raise UnknownName("sensor", name, tuple(PRESETS))
    preset = PRESETS[name]
    return {
        "name": name,
        "kind": preset.kind,
        "sentence": preset.sentence,
        "source": preset.source,
        "stages": dict(preset.values),
    }


def _kind(channel: type[AnalogueChannel | Tacho]) -> dict[str, object]:
    kind = str(channel.model_fields["kind"].default)
    stages = [name for name in channel.model_fields if name not in NO_STAGES]
    stages.sort(key=lambda name: LAST.index(name) if name in LAST else -1)
    return {
        "kind": kind,
        "sentence": (channel.__doc__ or "").splitlines()[0],
        "quantity": channel.QUANTITY,
        "unit": channel.UNIT,
        "stages": stages,
        "required": [name for name in stages if channel.model_fields[name].is_required()],
        "presets": [name for name, preset in PRESETS.items() if preset.kind == kind],
    }
