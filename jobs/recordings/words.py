"""Names that the parts of a recording's way share."""

from __future__ import annotations

RECORDING = "recording"
"""Kind of these jobs, and name of the document that makes a stored result a recording."""
SUMMARY = "summary"
"""Name of the document of what is in a recording, with the remarks of its reading."""
READERS_VERSION = "recording-1"
"""Part of a recording's identity: raised when the same file would be read as other numbers."""
UPLOAD = "upload"


def upload_key(job_id: str, suffix: str) -> str:
    """Where the file lies until it is read, and as long as the recording is kept."""
    return f"{job_id}/{UPLOAD}/data{suffix}"
