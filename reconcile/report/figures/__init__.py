"""Figures of the page, one kind a file; each takes plain data and returns markup."""
