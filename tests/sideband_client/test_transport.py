"""Retries, waiting and the mapping of refusals, against a scripted server."""

from __future__ import annotations

import re
from collections.abc import Callable

import httpx
import pytest

import sideband_client
from sideband_client import Client, Job, Progress, errors
from sideband_client.events import HEARTBEAT, ServerEvent, parse
from sideband_client.state import state_of
from tests.sideband_client.script import Script

Make = Callable[..., Client]


def problem(status: int, slug: str, **headers: str) -> httpx.Response:
    document = {"type": f"urn:sideband:problem:{slug}", "title": "T", "status": status, "detail": "d", "errors": []}
    return httpx.Response(status, json=document, headers={k.replace("_", "-"): v for k, v in headers.items()})


def job(status: str, fraction: float = 0.0) -> dict:
    return {
        "id": "j1",
        "status": status,
        "attempt": 1,
        "progress": {"fraction": fraction, "stage": "s", "eta_s": None},
        "request": {},
        "failure": None,
        "gone": None,
        "created_at": "2025-01-01T00:00:00Z",
    }


def answer(status: str, fraction: float = 0.0) -> httpx.Response:
    return httpx.Response(200, json=job(status, fraction))


def test_503_is_repeated_after_the_time_it_names_with_the_same_key(script: Script, scripted: Make) -> None:
    script.answers = [problem(503, "broker-away", Retry_After="7"), answer("accepted")]
    assert scripted().simulate("p").id == "j1"
    assert script.pauses == [7.0]
    keys = [request.headers["Idempotency-Key"] for request in script.requests]
    assert keys[0] == keys[1] and len(keys[0]) == 32
    assert script.requests[0].content == script.requests[1].content


def test_each_submission_has_a_key_of_its_own(script: Script, scripted: Make) -> None:
    script.answers = [answer("accepted"), answer("accepted")]
    client = scripted()
    client.simulate("p")
    client.simulate("p")
    assert len({request.headers["Idempotency-Key"] for request in script.requests}) == 2


def test_time_for_retries_is_bounded(script: Script, scripted: Make) -> None:
    script.answers = [problem(503, "store-away") for _ in range(50)]
    with pytest.raises(errors.ServiceAway):
        scripted(retry_for_s=10.0).presets()
    assert script.pauses == [0.25, 0.5, 1.0, 2.0, 4.0] and len(script.requests) == 6
    script.requests.clear()
    script.answers = [problem(429, "queue-full", Retry_After="30")]
    with pytest.raises(errors.Busy) as caught:
        scripted(retry_for_s=10.0).simulate("p")
    assert caught.value.retry_after_s == 30.0 and len(script.requests) == 1


def test_nobody_ever_heard_of_is_given_up_soon(script: Script, scripted: Make) -> None:
    script.answers = [httpx.ConnectError("refused") for _ in range(50)]
    client = scripted()
    with pytest.raises(errors.Unreachable):
        client.presets()
    assert sum(script.pauses) <= 3.0 and len(script.requests) == 4
    script.pauses.clear()
    script.answers = [httpx.Response(200, json={"presets": []}), *(httpx.ConnectError("refused") for _ in range(50))]
    client.presets()
    with pytest.raises(errors.Unreachable):
        client.presets()
    assert 30.0 < sum(script.pauses) <= 60.0, "one that answered once may be starting again"


def test_health_is_asked_once(script: Script, scripted: Make) -> None:
    for answered, kind in (
        (httpx.ConnectError("refused"), errors.Unreachable),
        (problem(503, "x"), errors.ServiceAway),
    ):
        script.answers = [answered]
        with pytest.raises(kind):
            scripted().health()
    assert script.pauses == [] and len(script.requests) == 2
    assert {request.extensions["timeout"]["connect"] for request in script.requests} == {2.5}


def test_what_a_repetition_could_harm_is_not_repeated_unless_it_never_left(script: Script, scripted: Make) -> None:
    running = Job(scripted()._transport, state_of(job("running")))
    script.answers = [httpx.ReadTimeout("silent")]
    with pytest.raises(errors.Unreachable):
        running.cancel()
    script.answers = [httpx.ConnectError("refused"), problem(503, "store-away"), answer("dismissed")]
    assert running.cancel().status == "dismissed"
    assert len(script.requests) == 4


STATUSES = [
    (400, "not-json", errors.BadRequest),
    (401, "unauthorized", errors.NotAllowed),
    (403, "foreign-page", errors.NotAllowed),
    (404, "unknown-job", errors.NotFound),
    (409, "conflict", errors.Conflict),
    (409, "not-ready", errors.NotReady),
    (410, "gone", errors.Gone),
    (413, "too-large", errors.TooLarge),
    (415, "wrong-media-type", errors.BadRequest),
    (422, "invalid-request", errors.InvalidRequest),
    (422, "idempotency-conflict", errors.KeyReused),
    (500, "internal", errors.ServerFault),
    (502, "http-502", errors.ServerFault),
    (507, "storage-full", errors.StorageFull),
]


@pytest.mark.parametrize(("status", "slug", "kind"), STATUSES)
def test_every_refusal_has_its_class(script: Script, scripted: Make, status: int, slug: str, kind: type) -> None:
    script.answers = [problem(status, slug)]
    with pytest.raises(errors.Refused) as caught:
        scripted().presets()
    assert type(caught.value) is kind and (caught.value.status, caught.value.problem) == (status, slug)


def test_the_tree_drawn_is_the_tree_there_is() -> None:
    drawn = dict[str, str]()
    parents = ["ClientError"]
    for line in (errors.__doc__ or "").splitlines():
        found = re.match(r"^[ |]* \+- (\w+)", line)
        if found:
            depth = line.index("+-") // 4 + 1
            parents[depth:] = [found[1]]
            drawn[found[1]] = parents[depth - 1]
    kinds = [k for k in vars(errors).values() if isinstance(k, type) and issubclass(k, errors.ClientError)]
    assert drawn == {k.__name__: k.__bases__[0].__name__ for k in kinds if k is not errors.ClientError}


def test_replies_of_something_else_are_no_crash(script: Script, scripted: Make) -> None:
    script.answers = [httpx.Response(502, text="<html>proxy</html>")]
    with pytest.raises(errors.ServerFault, match="proxy"):
        scripted().presets()
    for body in ("<html>", "[1]"):
        script.answers = [httpx.Response(200, text=body)]
        with pytest.raises(errors.BadReply):
            scripted().preset("p")
    script.answers = [httpx.Response(200, json={"id": "x"})]
    with pytest.raises(errors.BadReply, match="progress"):
        scripted().job("x")


def test_nobody_there() -> None:
    timing = sideband_client.Timing(retry_for_s=0.0)
    with (
        sideband_client.connect("http://127.0.0.1:9", timing=timing) as client,
        pytest.raises(errors.Unreachable, match=r"does not answer at http://127\.0\.0\.1:9/"),
    ):
        client.presets()


@pytest.mark.parametrize("url", ["", "localhost:8000", "ftp://host", "http://"])
def test_addresses_that_are_none(url: str) -> None:
    with pytest.raises(ValueError, match="url must be"):
        sideband_client.connect(url)


STREAM = (
    'id: 4\nevent: status\ndata: {"status":"running","progress":0.1,"stage":"s","eta_s":null,"attempt":1}\n\n: beat\n\n'
)


def stream(text: str) -> httpx.Response:
    return httpx.Response(200, text=text, headers={"Content-Type": "text/event-stream"})


def test_broken_stream_goes_on_after_the_last_event(script: Script, scripted: Make) -> None:
    script.answers = [stream(STREAM), answer("running", 0.2), httpx.Response(204), answer("successful", 1.0)]
    seen: list[Progress] = []
    Job(scripted()._transport, state_of(job("accepted"))).wait(progress=seen.append)
    assert "Last-Event-ID" not in script.requests[0].headers
    assert script.requests[2].headers["Last-Event-ID"] == "4"
    assert [told.fraction for told in seen] == [0.1, 0.2, 1.0]


def test_without_streams_the_server_is_asked(script: Script, scripted: Make) -> None:
    refused = [[problem(429, "queue-full"), answer("running", 0.1 * i)] for i in range(5)]
    script.answers = [*(a for pair in refused for a in pair), answer("running", 0.6), answer("successful", 1.0)]
    seen: list[Progress] = []
    Job(scripted()._transport, state_of(job("accepted"))).wait(progress=seen.append, poll_s=2.0)
    assert seen[-1].status == "successful" and script.pauses == [2.0] * 6
    assert [request.url.path for request in script.requests[-2:]] == ["/v1/jobs/j1"] * 2


def test_waiting_ends_in_time(script: Script, scripted: Make) -> None:
    script.answers = [a for _ in range(20) for a in (httpx.ReadTimeout("silent"), answer("running"))]
    with pytest.raises(TimeoutError, match="still running"):
        Job(scripted()._transport, state_of(job("running"))).wait(timeout_s=3.0)
    assert script.now == pytest.approx(3.0)


def test_events_are_parsed_as_the_standard_says() -> None:
    lines = ["retry: 5", "", ":x", "id: 7", "event:status", "data: a", "data:b", "", "data: cut"]
    assert list(parse(lines)) == [HEARTBEAT, ServerEvent(kind="status", data="a\nb", id="7")]


def test_strange_event_is_told(script: Script, scripted: Make) -> None:
    for text in ("data: {\n\n", "data: {}\n\n"):
        script.answers = [stream(text)]
        with pytest.raises(errors.BadReply):
            Job(scripted()._transport, state_of(job("running"))).wait()
