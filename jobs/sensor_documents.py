"""Sensors as documents, for those who put a measurement chain together."""

from __future__ import annotations

from signals.sensors.presets import PRESETS
from signals.sensors.spec import Accelerometer, ProximityProbe, Tacho, TorqueSensor, VelocitySensor

_KINDS = {
    str(model.model_fields["kind"].default): model
    for model in (Accelerometer, VelocitySensor, ProximityProbe, TorqueSensor, Tacho)
}


def sensor_documents() -> list[dict[str, object]]:
    """Every preset with its kind, what that measures, whether it sits at a place or on a shaft, and its stages."""
    return [
        {
            "name": name,
            "kind": preset.kind,
            "quantity": _KINDS[preset.kind].QUANTITY,
            "unit": _KINDS[preset.kind].UNIT,
            "sits": "place" if "place" in _KINDS[preset.kind].model_fields else "shaft",
            "sentence": preset.sentence,
            "source": preset.source,
            "values": dict(preset.values),
        }
        for name, preset in PRESETS.items()
    ]
