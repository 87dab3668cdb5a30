"""Forms that recordings are sent in by: what cannot be read or is called otherwise is named."""

from __future__ import annotations

import json
from typing import Any

import httpx
import pytest

ABOUT = json.dumps({"sampling_rate_hz": 1000.0, "channels": [{"name": "a", "unit": "g"}]})
DATA = b"a\n1\n2\n"


def refused(reply: httpx.Response, status: int) -> list[dict[str, Any]]:
    assert reply.status_code == status, reply.text
    assert reply.headers["content-type"].startswith("application/problem+json")
    errors: list[dict[str, Any]] = reply.json()["errors"]
    return errors


def test_a_misspelt_part_is_named_with_the_one_it_is_like(client: httpx.Client) -> None:
    sent = client.post("/v1/recordings", data={"description": ABOUT}, files={"fil": ("r.csv", DATA)})
    required, unknown = refused(sent, 422)
    assert (required["field"], required["message"]) == ("file", "is required")
    assert unknown["field"] == "fil" and "did you mean file?" in unknown["message"]
    assert unknown["allowed"] == "description, file"
    twice = [("file", ("a.csv", DATA)), ("file", ("b.csv", DATA))]
    (error,) = refused(client.post("/v1/recordings", data={"description": ABOUT}, files=twice), 422)
    assert (error["field"], error["given"]) == ("file", 2)


BROKEN = "multipart/form-data; boundary=x"
PART = b'--x\r\nContent-Disposition: form-data; name="a%d"; filename="f"\r\n\r\n1\r\n'


@pytest.mark.parametrize(
    ("content_type", "content", "field", "location", "says"),
    [
        ("multipart/form-data", b"x", "Content-Type", "header", "no boundary"),
        (BROKEN, b"no part", "request", "body", "invalid multipart data"),
        (BROKEN, b"".join(PART % k for k in range(5)) + b"--x--\r\n", "request", "body", "too many files"),
        (BROKEN, PART.replace(b"; filename", b"; other") * 9 + b"--x--\r\n", "request", "body", "too many fields"),
        (BROKEN, PART.replace(b'name="a%d"; filename="f"', b"x") + b"--x--\r\n", "request", "body", "must be provided"),
    ],
)
def test_a_form_that_cannot_be_read_says_where(
    client: httpx.Client, content_type: str, content: bytes, field: str, location: str, says: str
) -> None:
    reply = client.post("/v1/recordings", content=content, headers={"Content-Type": content_type})
    (error,) = refused(reply, 400)
    assert (error["field"], error["location"]) == (field, location) and says in error["message"] and error["allowed"]
