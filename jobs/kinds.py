"""What sets the kinds of jobs apart: which are part of another, and which go before which."""

from __future__ import annotations

from enum import StrEnum

from jobs.atlas.words import PIECE, ROUND
from jobs.datasets.words import ASSEMBLY, DATASET, PARTS, SHARD
from jobs.ports import Lane
from jobs.reconciliations.words import RECONCILIATION
from jobs.recordings.words import RECORDING


class Kind(StrEnum):
    """Every kind there is."""

    SIMULATION = "simulation"
    RECORDING = RECORDING
    RECONCILIATION = RECONCILIATION
    DATASET = DATASET
    DATASET_SHARD = SHARD
    DATASET_ASSEMBLY = ASSEMBLY
    ATLAS = ROUND
    ATLAS_PIECE = PIECE


INNER = (*PARTS, ROUND, PIECE)
"""Part of another job: left out of lists and counts, and nobody but that job decides over them."""
TICKETLESS = (DATASET, ROUND)
"""Never with the broker: their state follows from their parts."""
_LANES = {SHARD: Lane.BULK, PIECE: Lane.HELP}


def lane_of(kind: str) -> Lane:
    """Where the tickets of a kind wait."""
    return _LANES.get(kind, Lane.WHOLE)
