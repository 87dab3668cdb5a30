"""What every part of the client's door has: the connection, submissions under a name of their own, safe addresses."""

from __future__ import annotations

import uuid
from collections.abc import Iterator, Mapping
from typing import Any

from sideband_client.errors import BadReply
from sideband_client.job import Job
from sideband_client.state import state_of
from sideband_client.transport import Query, Transport

PAGE = 100


class Asking:
    """Has a connection to one server."""

    def __init__(self, transport: Transport) -> None:
        self._transport = transport

    def submitted(self, address: str, body: Mapping[str, Any], key: str | None) -> Job:
        """The job that a request became; sent again under its key it makes no second one."""
        # A name of its own for every submission: cancelling this job withdraws this submission and no other.
        submitter = f"client-{uuid.uuid4().hex[:16]}"
        headers = {"Idempotency-Key": key or uuid.uuid4().hex, "X-Submitter": submitter}
        document = self._transport.json("POST", address, body=body, headers=headers)
        return Job(self._transport, state_of(document), submitter=submitter)

    def listed(self, address: str, key: str, query: Query) -> Iterator[dict[str, Any]]:
        """Entries of a list of the server; pages are fetched as they are needed."""
        page = self._transport.json("GET", address, query={**query, "limit": PAGE})
        while True:
            yield from page[key]
            if page["next"] is None:
                return
            page = self._transport.json("GET", _following(page["next"], f"{address}?"))


def _following(address: object, start: str) -> str:
    """The next page's address, which must be of the same list."""
    if not str(address).startswith(start):
        raise BadReply(f"the next page of the list has a strange address: {address}")
    return str(address)


def segment(text: str) -> str:
    """Refuse what would be another address."""
    if not text or not all(c.isalnum() or c in "-_." for c in text) or text.strip(".") == "":
        raise ValueError(f"not a name: {text!r}")
    return text
