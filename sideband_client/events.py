"""Server-sent events (HTML Living Standard, section 9.2), as far as this service uses them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class ServerEvent:
    """An event; `kind` is `status` or `progress`, `data` JSON text. A heartbeat has the kind `heartbeat`, no data."""

    kind: str
    data: str
    id: str


HEARTBEAT = ServerEvent(kind="heartbeat", data="", id="")


def parse(lines: Iterable[str]) -> Iterator[ServerEvent]:
    """Events of a stream's lines. Comments come out as heartbeats; an event cut off by the end is dropped."""
    kind, data, identifier = "message", list[str](), ""
    for line in lines:
        if not line:
            if data:
                yield ServerEvent(kind=kind, data="\n".join(data), id=identifier)
            kind, data = "message", []
        elif line.startswith(":"):
            yield HEARTBEAT
        else:
            name, _, value = line.partition(":")
            value = value.removeprefix(" ")
            if name == "event":
                kind = value
            elif name == "data":
                data.append(value)
            elif name == "id":
                identifier = value
