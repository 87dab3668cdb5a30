"""Recordings that were sent in: kept before the reply, read by a worker, served like results of simulations."""
