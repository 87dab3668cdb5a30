"""A job on the server: wait for it, cancel it, delete it, get its result."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Self

import httpx

from sideband_client.dataset import Dataset
from sideband_client.errors import (
    BadReply,
    Busy,
    Gone,
    JobDismissed,
    JobFailed,
    NotReady,
    ServerFault,
    ServiceAway,
    Unreachable,
    WaitedTooLong,
)
from sideband_client.events import HEARTBEAT, parse
from sideband_client.reconciliation import Reconciliation
from sideband_client.result import Result
from sideband_client.state import JobState, Progress, progress_of, state_of
from sideband_client.transport import Transport

NO_MORE = 204
STREAM_TRIES = 5
"""Streams opened before waiting goes on by asking alone: a proxy may not let them through."""
POLL_S = 1.0


class Job:
    """`state` is how the job stood when the server was last asked; `refresh` asks again."""

    def __init__(self, transport: Transport, state: JobState, *, submitter: str | None = None) -> None:
        self._transport, self._submitter = transport, submitter
        self.state = state
        self.id = state.id
        self._path = f"/v1/jobs/{state.id}"
        self._last_event = ""

    def __repr__(self) -> str:
        return f"<Job {self.id} {self.state.status}>"

    @property
    def status(self) -> str:
        """accepted, running, successful, failed or dismissed, when the server was last asked."""
        return self.state.status

    def refresh(self) -> JobState:
        """Ask the server how the job stands."""
        self.state = state_of(self._transport.json("GET", self._path))
        return self.state

    def wait(
        self,
        *,
        progress: Callable[[Progress], None] | None = None,
        timeout_s: float | None = None,
        poll_s: float = POLL_S,
    ) -> Self:
        """Return when the job was successful; raises JobFailed, JobDismissed, WaitedTooLong (the job goes on).

        Progress comes as server-sent events; when the stream breaks it is opened again where it stopped, and when it
        breaks often or is refused the server is asked every `poll_s` seconds instead.
        """
        end = None if timeout_s is None else self._transport.monotonic() + timeout_s
        streams = 0
        while not self.state.ended:
            if streams < STREAM_TRIES:
                streams += 1
                self._listen(progress, end)
            if self.refresh().ended:
                break
            if progress is not None:
                progress(self.state.progress)
            self._transport.sleep(min(poll_s, self._left(end)))
        if progress is not None:
            progress(self.state.progress)
        self._raise_if_over()
        return self

    def result(self) -> Result:
        """The result, at once: JobFailed, JobDismissed, NotReady (under way) or Gone say why there is none."""
        self._raise_unless_there()
        return Result(self._transport, self.id)

    def dataset(self) -> Dataset:
        """The result of `make_dataset`, as `result` is had."""
        self._raise_unless_there()
        return Dataset(self._transport, self.id)

    def reconciliation(self) -> Reconciliation:
        """The result of `reconcile`, as `result` is had."""
        self._raise_unless_there()
        return Reconciliation(self._transport, self.id)

    def _raise_unless_there(self) -> None:
        state = self.state if self.state.ended else self.refresh()
        if state.gone is not None:
            message = f"the result of job {self.id} is {state.gone}; submitting again makes it again"
            raise Gone(message, status=410, problem="gone")
        self._raise_if_over()
        if not state.ended:
            message = f"job {self.id} is {state.status} and has no result yet; wait() for it"
            raise NotReady(message, status=409, problem="not-ready", retry_after_s=POLL_S)

    def cancel(self, *, everyone: bool = False) -> JobState:
        """Withdraw this submission; the work stops when nobody else waits for it. `everyone`: stop it for all."""
        headers = {"X-Submitter": self._submitter} if self._submitter and not everyone else None
        document = self._transport.json(
            "POST", f"{self._path}/cancel", body={"everyone": everyone}, headers=headers, repeatable=False
        )
        self.state = state_of(document)
        return self.state

    def delete(self) -> None:
        """Forget the finished job and its result; one under way must be cancelled first."""
        self._transport.send("DELETE", self._path, repeatable=False)

    def _left(self, end: float | None) -> float:
        if end is None:
            return float("inf")
        left = end - self._transport.monotonic()
        if left <= 0:
            raise WaitedTooLong(f"job {self.id} is still {self.state.status}; it goes on")
        return left

    def _listen(self, progress: Callable[[Progress], None] | None, end: float | None) -> None:
        """Pass events on until the stream ends, however it does; what it missed is asked for afterwards."""
        headers = {"Accept": "text/event-stream"} | ({"Last-Event-ID": self._last_event} if self._last_event else {})
        silence_s = min(self._transport.timing.heartbeat_s, self._left(end))
        try:
            with self._transport.stream(f"{self._path}/events", headers=headers, silence_s=silence_s) as reply:
                for told in self._told(reply):
                    if told is not None and progress is not None:
                        progress(told)
                    self._left(end)
        except (Unreachable, ServiceAway, Busy, ServerFault):
            return

    def _told(self, reply: httpx.Response) -> Iterator[Progress | None]:
        """Progress of each event, None for a heartbeat."""
        if reply.status_code == NO_MORE:
            return
        for event in parse(reply.iter_lines()):
            if event is HEARTBEAT:
                yield None
                continue
            self._last_event = event.id or self._last_event
            yield _progress(event.data)

    def _raise_if_over(self) -> None:
        """JobDismissed or JobFailed when the job ended so."""
        if self.state.status == "dismissed":
            raise JobDismissed(f"job {self.id} was cancelled")
        if self.state.status == "failed":
            failure = dict(self.state.failure or {})
            raise JobFailed(
                self.id,
                str(failure.get("code", "unknown")),
                str(failure.get("message", "no reason given")),
                str(failure.get("advice", "")),
                failure.get("detail"),
            )


def _progress(text: str) -> Progress:
    try:
        data = json.loads(text)
    except ValueError as error:
        raise BadReply("an event of the server is not JSON") from error
    return progress_of(data)
