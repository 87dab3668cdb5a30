"""Health of a machine over time: features kept with each of its recordings, baselines, alarms with their rules."""
