"""Physical effects, one file each; see sim.core.registry."""
