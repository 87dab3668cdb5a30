"""Time integration and its plain twins."""
