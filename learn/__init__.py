"""From simulation to real machines: a classifier of bearing and gear faults that has seen simulated recordings only."""
