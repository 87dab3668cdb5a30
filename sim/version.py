"""Version of the physics: part of every result's identity."""

PHYSICS_VERSION = "1.2.0"
