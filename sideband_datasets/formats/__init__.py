"""Shards in the formats that training pipelines read. Each writes the same bytes for the same rows."""

from sideband_datasets.formats.format import FORMATS, Format, format_named
from sideband_datasets.formats.record import Record, fingerprint, record_of

__all__ = ["FORMATS", "Format", "Record", "fingerprint", "format_named", "record_of"]
