"""The door: `connect`, and what can be asked of a server."""

from __future__ import annotations

import uuid
from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime
from types import TracebackType
from typing import Any, Literal, Self
from urllib.parse import urlsplit

import httpx

from sideband_client.dataset import Dataset
from sideband_client.errors import BadReply
from sideband_client.job import Job
from sideband_client.state import JobState, state_of
from sideband_client.transport import Timing, Transport

PAGE = 100
Changes = Mapping[str, bool | float | str | Mapping[str, Any] | None]
"""`term@site.parameter`, a short name (`speed_hz`, `torque_nm`, `profile`, `gravity`) or a dotted path; SI units."""


def connect(url: str, *, api_key: str | None = None, timing: Timing | None = None) -> Client:
    """A client of the server at `url` (`http://127.0.0.1:8000`). Nothing is sent before the first question."""
    chosen = timing or Timing()
    parts = urlsplit(url)
    if parts.scheme not in ("http", "https") or not parts.hostname:
        raise ValueError(f"url must be http://HOST[:PORT] or https://HOST[:PORT], not {url!r}")
    headers = {"Accept": "application/json"} | ({"Authorization": f"Bearer {api_key}"} if api_key else {})
    http = httpx.Client(
        base_url=url, headers=headers, timeout=httpx.Timeout(chosen.connect_s, read=chosen.read_s, write=chosen.read_s)
    )
    return Client(Transport(http, chosen))


class Client:
    """Use it in a `with` block or close it. Not to be shared between processes; threads may share it."""

    def __init__(self, transport: Transport) -> None:
        self._transport = transport

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Give back the connections."""
        self._transport.close()

    def simulate(
        self,
        machine: str | Mapping[str, Any],
        *,
        set: Changes | None = None,
        duration_s: float = 1.0,
        sampling_rate_hz: float = 30_000.0,
        channels: Sequence[str] | Literal["all"] | None = None,
        seed: int = 0,
        discard_transient: bool = True,
        sensors: Mapping[str, Any] | None = None,
        causes: bool = False,
        idempotency_key: str | None = None,
        overrides: Changes | None = None,
    ) -> Job:
        """Ask for a simulation of a preset (its name) or of a whole machine specification.

        `set`: what to change in it (`overrides` is its older name). `sensors`: a measurement chain (docs/sensors.md)
        whose channels are recorded in place of `channels`. `causes`: show what causes each line. The same request
        shares one job and one result. Repeated after a lost reply under the same key, it makes no second job; the key
        is made here unless given. Raises InvalidRequest with the fields to change, Busy, ServiceAway, StorageFull,
        Unreachable.
        """
        body = _choice(machine, set, overrides)
        body |= {"duration_s": duration_s, "sampling_rate_hz": sampling_rate_hz, "seed": seed}
        body |= {"discard_transient": discard_transient}
        if channels is not None:
            body["channels"] = channels if isinstance(channels, str) else list(channels)
        if sensors is not None:
            body["sensors"] = dict(sensors)
        if causes:
            body["causes"] = True
        return self._submitted("/v1/simulations", body, idempotency_key)

    def make_dataset(
        self,
        recipe: str | Mapping[str, Any],
        *,
        format: str = "parquet",
        shard_recordings: int | None = None,
        idempotency_key: str | None = None,
    ) -> Job:
        """Ask for a dataset by the name of a ready recipe or by a whole one (docs/datasets.md).

        The same recipe and format share one dataset; one that failed or was cancelled is taken up where it stopped.
        `job.wait().dataset().download(folder)` fetches it. Raises as `simulate`.
        """
        return self._submitted("/v1/datasets", _recipe(recipe, format, shard_recordings), idempotency_key)

    def estimate_dataset(
        self, recipe: str | Mapping[str, Any], *, format: str = "parquet", shard_recordings: int | None = None
    ) -> dict[str, Any]:
        """Rows, bytes, core-seconds, time with the workers there are, class balance, warnings; nothing is made."""
        body = _recipe(recipe, format, shard_recordings)
        return self._transport.json("POST", "/v1/datasets/estimate", body=body)

    def recipes(self) -> dict[str, Any]:
        """Ready `recipes` as a whole, the `formats`, and the `recipe_schema`."""
        return self._transport.json("GET", "/v1/datasets/recipes")

    def dataset(self, dataset_id: str) -> Dataset:
        """A finished dataset by its id."""
        return Dataset(self._transport, _segment(dataset_id))

    def _submitted(self, address: str, body: Mapping[str, Any], key: str | None) -> Job:
        # A name of its own for every submission: cancelling this job withdraws this submission and no other.
        submitter = f"client-{uuid.uuid4().hex[:16]}"
        headers = {"Idempotency-Key": key or uuid.uuid4().hex, "X-Submitter": submitter}
        document = self._transport.json("POST", address, body=body, headers=headers)
        return Job(self._transport, state_of(document), submitter=submitter)

    def check(
        self,
        machine: str | Mapping[str, Any],
        *,
        set: Changes | None = None,
        overrides: Changes | None = None,
    ) -> dict[str, Any]:
        """What assembly says of a machine (frequencies, channels, warnings); nothing is simulated."""
        return self._transport.json("POST", "/v1/machines/check", body=_choice(machine, set, overrides))

    def job(self, job_id: str) -> Job:
        """A job by its id; raises NotFound, Gone."""
        return Job(self._transport, state_of(self._transport.json("GET", f"/v1/jobs/{_segment(job_id)}")))

    def jobs(
        self, *, status: Sequence[str] | None = None, preset: str | None = None, sort: str = "-created_at"
    ) -> Iterator[JobState]:
        """Jobs, the newest first; pages are fetched as they are needed."""
        query = {"status": status, "preset": preset, "sort": sort, "limit": PAGE}
        page = self._transport.json("GET", "/v1/jobs", query=query)
        while True:
            yield from (state_of(document) for document in page["jobs"])
            following = page["next"]
            if following is None:
                return
            page = self._transport.json("GET", _following(following, "/v1/jobs?"))

    def presets(self) -> list[dict[str, Any]]:
        """The preset machines: `name`, `title`, `notes`."""
        return list(self._transport.json("GET", "/v1/presets")["presets"])

    def preset(self, name: str) -> dict[str, Any]:
        """A preset as a whole machine specification, to be changed and simulated."""
        return self._transport.json("GET", f"/v1/presets/{_segment(name)}")

    def terms(self) -> list[dict[str, Any]]:
        """The physical effects a machine can have, with parameters, units and bounds."""
        return list(self._transport.json("GET", "/v1/terms")["terms"])

    def sensors(self) -> dict[str, Any]:
        """What a measurement chain can be made of: `kinds` of channels, `presets` by name, the JSON `schema`."""
        return self._transport.json("GET", "/v1/sensors")

    def bearings(self) -> list[dict[str, Any]]:
        """The bearing catalogue."""
        return list(self._transport.json("GET", "/v1/bearings")["bearings"])

    def machines(self) -> Iterator[dict[str, Any]]:
        """The machines that recordings name: `name`, `recordings`, `last_seen`, `state`, `worst`, by name."""
        page = self._transport.json("GET", "/v1/machines", query={"limit": PAGE})
        while True:
            yield from page["machines"]
            if page["next"] is None:
                return
            page = self._transport.json("GET", _following(page["next"], "/v1/machines?"))

    def machine_health(
        self,
        name: str,
        *,
        start: datetime | str | None = None,
        end: datetime | str | None = None,
        channels: Sequence[str] | None = None,
        features: Sequence[str] | None = None,
        limit: int = PAGE,
    ) -> dict[str, Any]:
        """A machine over time: `points` (recordings), `series` of features with limits, `alarms`, `verdicts`.

        The latest `limit` recordings (500 at most) from `start` to `end` (with an offset from UTC); `end` at the first
        point's time asks for those before. Raises NotFound for an unknown machine or channel.
        """
        query = {"from": _moment(start), "to": _moment(end), "channel": channels, "feature": features, "limit": limit}
        return self._transport.json("GET", f"/v1/machines/{_segment(name)}/health", query=query)

    def health(self) -> dict[str, Any]:
        """How the service and each part of it is; `status` is ok, degraded or away.

        Asked once: a server that is not there is told (Unreachable) within `Timing.probe_connect_s`.
        """
        return self._transport.json("GET", "/v1/health", probe=True)


def _following(address: object, start: str) -> str:
    """The next page's address, which must be of the same list."""
    if not str(address).startswith(start):
        raise BadReply(f"the next page of the list has a strange address: {address}")
    return str(address)


def _moment(time: datetime | str | None) -> str | None:
    return time.isoformat() if isinstance(time, datetime) else time


def _choice(machine: str | Mapping[str, Any], changes: Changes | None, older_name: Changes | None) -> dict[str, Any]:
    """A machine and its changes as the server takes them."""
    if changes is not None and older_name is not None:
        raise ValueError("give `set` or its older name `overrides`, not both")
    body: dict[str, Any] = {"preset": machine} if isinstance(machine, str) else {"machine": dict(machine)}
    return {**body, "set": dict(changes or older_name or {})}


def _recipe(recipe: str | Mapping[str, Any], format: str, shard_recordings: int | None) -> dict[str, Any]:
    body: dict[str, Any] = {"recipe": recipe if isinstance(recipe, str) else dict(recipe), "format": format}
    return body if shard_recordings is None else {**body, "shard_recordings": shard_recordings}


def _segment(text: str) -> str:
    """Refuse what would be another address."""
    if not text or not all(c.isalnum() or c in "-_." for c in text) or text.strip(".") == "":
        raise ValueError(f"not a name: {text!r}")
    return text
