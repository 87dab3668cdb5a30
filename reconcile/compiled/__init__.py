"""Loops of the analyses, compiled: the same numbers as arrays give, to the last bit, without their way through memory.

The package imports no analysis but the laws of a force, so that loops can be compiled beforehand without loading one.
"""
