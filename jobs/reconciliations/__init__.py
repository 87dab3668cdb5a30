"""Reconciliations of stored recordings with a machine: accepted like simulations, carried out by a worker."""
