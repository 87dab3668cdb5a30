"""Recordings from files: a description in JSON (`R.json`) and the data beside it, in the formats of the field.

Rates and units are never guessed; what is wrong is refused with its place. See docs/recordings.md.
"""

from __future__ import annotations

from signals.ingest.description import Description, moment, read_description
from signals.ingest.file import data_file, ingest, load_description, read_recording
from signals.ingest.parse import Ingested, check_units, parse
from signals.ingest.report import report
from signals.readers.formats import FORMATS, suffix_of
from signals.readers.limits import Bounds

__all__ = [
    "FORMATS",
    "Bounds",
    "Description",
    "Ingested",
    "check_units",
    "data_file",
    "ingest",
    "load_description",
    "moment",
    "parse",
    "read_description",
    "read_recording",
    "report",
    "suffix_of",
]
