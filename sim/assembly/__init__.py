"""Specification to matrices, loads and contact elements."""
