"""From a recipe to its recordings: which machine, fault, operating point and split, before anything is simulated."""

from sideband_datasets.plan.drawing import Drawing, Effect, drawing
from sideband_datasets.plan.estimate import Estimate, estimate
from sideband_datasets.plan.machines import Machine
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.tried import make_plan

__all__ = ["Drawing", "Effect", "Estimate", "Machine", "Plan", "drawing", "estimate", "make_plan"]
