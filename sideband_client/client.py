"""The door: `connect`, and what can be asked of a server."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import TracebackType
from typing import Any, Literal, Self
from urllib.parse import urlsplit

import httpx

from sideband_client.asking import segment
from sideband_client.dataset import Dataset
from sideband_client.job import Job
from sideband_client.measured import Measured
from sideband_client.state import JobState, state_of
from sideband_client.transport import Timing, Transport

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


class Client(Measured):
    """Use it in a `with` block or close it. Not to be shared between processes; threads may share it."""

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
        return self.submitted("/v1/simulations", body, idempotency_key)

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
        return self.submitted("/v1/datasets", _recipe(recipe, format, shard_recordings), idempotency_key)

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
        return Dataset(self._transport, segment(dataset_id))

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
        return Job(self._transport, state_of(self._transport.json("GET", f"/v1/jobs/{segment(job_id)}")))

    def jobs(
        self, *, status: Sequence[str] | None = None, preset: str | None = None, sort: str = "-created_at"
    ) -> Iterator[JobState]:
        """Jobs, the newest first; pages are fetched as they are needed."""
        query = {"status": status, "preset": preset, "sort": sort}
        return map(state_of, self.listed("/v1/jobs", "jobs", query))

    def presets(self) -> list[dict[str, Any]]:
        """The preset machines: `name`, `title`, `notes`."""
        return list(self._transport.json("GET", "/v1/presets")["presets"])

    def preset(self, name: str) -> dict[str, Any]:
        """A preset as a whole machine specification, to be changed and simulated."""
        return self._transport.json("GET", f"/v1/presets/{segment(name)}")

    def terms(self) -> list[dict[str, Any]]:
        """The physical effects a machine can have, with parameters, units and bounds."""
        return list(self._transport.json("GET", "/v1/terms")["terms"])

    def sensors(self) -> dict[str, Any]:
        """What a measurement chain can be made of: `kinds` of channels, `presets` by name, the JSON `schema`."""
        return self._transport.json("GET", "/v1/sensors")

    def bearings(self) -> list[dict[str, Any]]:
        """The bearing catalogue."""
        return list(self._transport.json("GET", "/v1/bearings")["bearings"])

    def health(self) -> dict[str, Any]:
        """How the service and each part of it is; `status` is ok, degraded or away.

        Asked once: a server that is not there is told (Unreachable) within `Timing.probe_connect_s`.
        """
        return self._transport.json("GET", "/v1/health", probe=True)


def _choice(machine: str | Mapping[str, Any], changes: Changes | None, older_name: Changes | None) -> dict[str, Any]:
    """A machine and its changes as the server takes them."""
    if changes is not None and older_name is not None:
        raise ValueError("give `set` or its older name `overrides`, not both")
    body: dict[str, Any] = {"preset": machine} if isinstance(machine, str) else {"machine": dict(machine)}
    return {**body, "set": dict(changes or older_name or {})}


def _recipe(recipe: str | Mapping[str, Any], format: str, shard_recordings: int | None) -> dict[str, Any]:
    body: dict[str, Any] = {"recipe": recipe if isinstance(recipe, str) else dict(recipe), "format": format}
    return body if shard_recordings is None else {**body, "shard_recordings": shard_recordings}
