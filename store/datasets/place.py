"""Where a dataset goes, from the URL that was typed."""

from __future__ import annotations

from store.artefacts.place import S3Place, s3_place

ALLOWED = "s3://BUCKET[/PREFIX][?endpoint=http://HOST:PORT&region=NAME]"


def dataset_place(url: str) -> S3Place:
    """Read the URL; raises SpecError of the field URL."""
    return s3_place(url, "URL", ALLOWED)
