"""The simulations of a reconciliation, shared with whichever workers are idle."""
