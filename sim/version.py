"""Version of the physics: part of every result's identity."""

PHYSICS_VERSION = "1.1.0"
