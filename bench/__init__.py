"""Benchmarks: speed, error, memory and start, printed; never part of the tests."""
