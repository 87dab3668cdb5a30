"""Numbers from signals: pure functions of arrays."""
