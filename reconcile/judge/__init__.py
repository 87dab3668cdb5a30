"""Stages 2 to 5: is anything missing, where, what, how large - and may it be named."""
