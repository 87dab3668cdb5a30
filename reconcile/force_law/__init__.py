"""From an estimated force to a law: its picture with bands, its work, and the simplest formula that survives."""
