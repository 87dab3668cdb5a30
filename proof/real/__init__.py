"""Measured recordings with known truth, brought into the form in which anyone describes a recording."""
