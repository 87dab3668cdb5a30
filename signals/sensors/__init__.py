"""The measurement chain: what sensors and a recorder make of a machine's motion."""

from signals.sensors.measure import measure
from signals.sensors.motion import Motion, motion_of
from signals.sensors.pickups import outputs_needed, pickups, quantities_of
from signals.sensors.presets import PRESETS
from signals.sensors.report import ChannelReport, Measured
from signals.sensors.spec import SensorChain

__all__ = [
    "PRESETS",
    "ChannelReport",
    "Measured",
    "Motion",
    "SensorChain",
    "measure",
    "motion_of",
    "outputs_needed",
    "pickups",
    "quantities_of",
]
