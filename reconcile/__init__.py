"""Reconcile a simulation with recordings: locate the mismatch, name the physics left out, show the fit improve."""
