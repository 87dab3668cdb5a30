"""Eight machines of one structure side by side, every number a vector register."""
