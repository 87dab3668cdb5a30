"""Names that the parts of an atlas' way share."""

from __future__ import annotations

ROUND = "atlas"
"""Kind of the job that stands for machines which a reconciliation wants simulated together; it holds no ticket."""
PIECE = "atlas-piece"
"""Kind of the jobs that simulate some of them each."""
METHOD_VERSION = "atlas-2"
"""Part of a round's identity beside the versions of what makes its numbers."""
KEPT_S = 86_400.0
"""How long the pieces of a round are kept: for the next reconciliation of the machine, and for a second attempt."""
