"""How fast a shaft turned in a recording, and its angle at every sample."""

from reconcile.speed.angle import shaft_angle
from reconcile.speed.estimate import Method, SpeedEstimate, estimate_speed, line_logs
from reconcile.speed.follow import followed_angle

__all__ = ["Method", "SpeedEstimate", "estimate_speed", "followed_angle", "line_logs", "shaft_angle"]
