"""From a recipe to its recordings: which machine, fault, operating point and split, before anything is simulated."""

from sideband_datasets.plan.drawing import Drawing, Effect, drawing
from sideband_datasets.plan.estimate import Estimate, estimate
from sideband_datasets.plan.machines import Machine
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.size import MOST_SHARD_BYTES, check_shard, least_bytes, most_recordings, recording_bytes
from sideband_datasets.plan.tried import make_plan, plan_again

__all__ = [
    "MOST_SHARD_BYTES",
    "Drawing",
    "Effect",
    "Estimate",
    "Machine",
    "Plan",
    "check_shard",
    "drawing",
    "estimate",
    "least_bytes",
    "make_plan",
    "most_recordings",
    "plan_again",
    "recording_bytes",
]
