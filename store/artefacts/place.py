"""A place in an object store, from a URL."""

from __future__ import annotations

import re
from dataclasses import dataclass
from urllib.parse import parse_qsl, urlsplit

from sim.core.errors import Problem, SpecError

ALLOWED = "file:///absolute/folder or s3://BUCKET[/PREFIX][?endpoint=http://HOST:PORT&region=NAME]"
_BUCKET = re.compile(r"[a-z0-9][a-z0-9.-]{1,61}[a-z0-9]")
_PREFIX = re.compile(r"([A-Za-z0-9][A-Za-z0-9._-]*(/[A-Za-z0-9][A-Za-z0-9._-]*)*)?")
_REGION = re.compile(r"[a-z0-9-]{1,40}")


@dataclass(frozen=True, kw_only=True)
class S3Place:
    """A bucket and the prefix of every key in it. `endpoint`: of a server that is not Amazon's; empty otherwise."""

    bucket: str
    prefix: str = ""
    endpoint: str = ""
    region: str = ""


def s3_place(url: str, field: str = "ARTEFACT_URL", allowed: str = ALLOWED) -> S3Place:
    """Read `s3://bucket/prefix?endpoint=...&region=...`; raises SpecError, of the `field` that the URL was given in.

    Keys of access never stand in the URL.
    """

    def refused(message: str, given: str | None) -> SpecError:
        return SpecError(Problem(field=field, message=message, given=given, allowed=allowed))

    try:
        parts = urlsplit(url)
        query = parse_qsl(parts.query, keep_blank_values=True, strict_parsing=bool(parts.query))
    except ValueError as error:
        raise refused("is not a URL", None) from error
    if "@" in parts.netloc:
        # Not repeated: a secret is in it.
        raise refused("must not hold a secret; set AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY", None)
    if parts.scheme != "s3":
        raise refused("is not of a bucket", url)
    options = dict(query)
    unknown = sorted(set(options) - {"endpoint", "region"})
    if unknown or len(options) != len(query):
        raise refused(f"has an option it does not know or a repeated one: {', '.join(unknown) or 'repeated'}", url)
    place = S3Place(bucket=parts.netloc, prefix=parts.path.strip("/"), **options)
    if not _BUCKET.fullmatch(place.bucket):
        raise refused("does not name a bucket", url)
    if not _PREFIX.fullmatch(place.prefix) or ".." in place.prefix:
        raise refused("has a prefix of other than letters, digits, `.`, `_`, `-` and `/`", url)
    if place.endpoint and not _is_endpoint(place.endpoint):
        raise refused("has an endpoint that is not http://HOST[:PORT] or https://HOST[:PORT]", url)
    if place.region and not _REGION.fullmatch(place.region):
        raise refused("has a region that is not a region's name", url)
    return place


def _is_endpoint(text: str) -> bool:
    parts = urlsplit(text)
    return parts.scheme in ("http", "https") and bool(parts.hostname) and parts.path in ("", "/") and not parts.query
