"""Stage 1: what is uncertain about the machine, and the path from its motion to the recorded samples."""
