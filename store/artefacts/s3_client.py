"""Connections to an object store."""

from __future__ import annotations

import os
from typing import Any

import boto3
from botocore.config import Config

from store.artefacts.place import S3Place

WORK = Config(connect_timeout=5, read_timeout=30, retries={"mode": "standard", "total_max_attempts": 3})
PROBE = Config(connect_timeout=2, read_timeout=2, retries={"mode": "standard", "total_max_attempts": 1})


def connected(place: S3Place, config: Config) -> Any:  # noqa: ANN401  (boto3 makes its classes at run time)
    """A client; nothing is asked yet. Credentials come from where boto3 looks for them; raises BotoCoreError."""
    style = Config(s3={"addressing_style": "path" if place.endpoint else "auto"}, signature_version="s3v4")
    return boto3.session.Session().client(
        "s3",
        endpoint_url=place.endpoint or None,
        region_name=place.region or os.environ.get("AWS_REGION") or "us-east-1",
        config=config.merge(style),
    )
