"""Measured recordings beside the project, for evaluation only: nothing here is ever fitted to."""
