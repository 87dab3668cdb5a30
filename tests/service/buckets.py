"""An S3-compatible server (moto's) on a free loopback port, with one bucket."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

import boto3
import pytest
from botocore.loaders import JSONFileLoader
from moto.server import ThreadedMotoServer

BUCKET = "results"
READ = cache(JSONFileLoader().load_file)
"""Descriptions of a service, of which every session reads megabytes again."""
CREDENTIALS = {"AWS_ACCESS_KEY_ID": "test", "AWS_SECRET_ACCESS_KEY": "test"}


@contextmanager
def bucket_server(bucket: str = BUCKET) -> Iterator[str]:
    """Its endpoint. All servers of a process share their objects: who counts them takes a bucket of another name.

    Credentials are set in the environment for as long as it lives, so that no real ones are sent."""
    with pytest.MonkeyPatch.context() as patch:
        for name, value in CREDENTIALS.items():
            patch.setenv(name, value)
        for name in ("AWS_PROFILE", "AWS_SESSION_TOKEN", "AWS_REGION", "AWS_DEFAULT_REGION"):
            patch.delenv(name, raising=False)
        patch.setattr(JSONFileLoader, "load_file", lambda _self, path: READ(path))
        server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
        server.start()
        try:
            host, port = server.get_host_and_port()
            endpoint = f"http://{host}:{port}"
            raw_client(endpoint).create_bucket(Bucket=bucket)
            yield endpoint
        finally:
            server.stop()


def raw_client(endpoint: str):
    """For looking behind the store's back."""
    return _session().client("s3", endpoint_url=endpoint, region_name="us-east-1")


@cache
def _session() -> boto3.session.Session:
    return boto3.session.Session(
        aws_access_key_id=CREDENTIALS["AWS_ACCESS_KEY_ID"], aws_secret_access_key=CREDENTIALS["AWS_SECRET_ACCESS_KEY"]
    )
