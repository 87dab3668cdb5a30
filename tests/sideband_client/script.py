"""A scripted server: what it answers is written down beforehand."""

from __future__ import annotations

import httpx

from sideband_client import Timing
from sideband_client.transport import Transport


class Script:
    """Answers one request after the other with what was written down for it; keeps requests and pauses."""

    def __init__(self) -> None:
        self.answers: list[httpx.Response | Exception] = []
        self.requests: list[httpx.Request] = []
        self.pauses: list[float] = []
        self.now = 0.0

    def __call__(self, request: httpx.Request) -> httpx.Response:
        request.read()
        self.requests.append(request)
        answer = self.answers.pop(0)
        if isinstance(answer, Exception):
            raise answer
        return answer

    def sleep(self, seconds: float) -> None:
        self.pauses.append(seconds)
        self.now += seconds

    def transport(self, **timing: float) -> Transport:
        http = httpx.Client(transport=httpx.MockTransport(self), base_url="http://sideband")
        return Transport(http, Timing(**timing), sleep=self.sleep, monotonic=lambda: self.now)
