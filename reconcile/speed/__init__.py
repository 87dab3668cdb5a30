"""How fast a shaft turned in a recording, and its angle at every sample."""

from reconcile.speed.angle import shaft_angle
from reconcile.speed.estimate import Method, SpeedEstimate, estimate_speed

__all__ = ["Method", "SpeedEstimate", "estimate_speed", "shaft_angle"]
