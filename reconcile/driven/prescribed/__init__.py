"""Motion in, force out: what resists a prescribed motion, with memory (friction behind a spring and backlash)."""
