"""The whole service as users start it, and a browser on it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.browser.driver import Browser, eventually, missing

ROOT = Path(__file__).resolve().parents[2]
SERVE = (
    "import sys; from pathlib import Path; from app.serve import serve; "
    "raise SystemExit(serve(port=0, workers=1, data_dir=Path(sys.argv[1])))"
)
DEMO: dict[str, Any] = {
    "preset": "paper-demo",
    "duration_s": 1.2,
    "sampling_rate_hz": 20000,
    "channels": [
        "resonator1.y.acceleration",
        "resonator2.y.acceleration",
        "bearing1.inner.x.displacement",
        "bearing1.inner.y.displacement",
        "mesh1.stiffness",
        "bearing1.wall.normal_force",
    ],
}


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """A browser and a service take seconds to start."""
    for item in items:
        if Path(__file__).parent in item.path.parents:
            item.add_marker(pytest.mark.slow)
            item.add_marker(pytest.mark.xdist_group("browser"))


@pytest.fixture(scope="session")
def browser_there() -> None:
    gaps = missing()
    if gaps and os.environ.get("CI"):
        pytest.fail(f"browser tests must run here, but there is no {gaps}")
    if gaps:
        pytest.skip(f"no {gaps} on this machine (Debian: apt-get install chromium chromium-driver)")


@dataclass(frozen=True, kw_only=True)
class Service:
    """A running service; `demo` is a finished job."""

    url: str
    demo: str
    client: httpx.Client

    def page(self, path: str = "/") -> str:
        """Address of a page of the dashboard."""
        return f"{self.url}#{path}"

    def wait(self, job_id: str, status: str, *, within_s: float = 120.0) -> None:
        """Until the job stands so."""

        def stands() -> bool:
            found = self.client.get(f"/v1/jobs/{job_id}").json()["status"]
            assert found == status or found in ("accepted", "running"), f"the job is {found}"
            return bool(found == status)

        eventually(stands, within_s=within_s, what=f"job {job_id} to be {status}")


# Both end with the last of these tests: an open page asks how its jobs stand, a minute of processor till the end.
@pytest.fixture(scope="package")
def service(browser_there: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    folder = tmp_path_factory.mktemp("service")
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("SIDEBAND_", "REDIS_", "DATABASE_"))}
    process = subprocess.Popen(
        [sys.executable, "-c", SERVE, str(folder)], cwd=ROOT, env=environment, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    try:
        line = process.stdout.readline()
        assert line.startswith("Sideband is at "), f"the service did not start: {line!r}"
        url = line.removeprefix("Sideband is at ").strip()
        with httpx.Client(base_url=url, timeout=30, trust_env=False) as client:
            demo = client.post("/v1/simulations", json=DEMO).raise_for_status().json()["id"]
            running = Service(url=url, demo=demo, client=client)
            running.wait(demo, "successful")
            yield running
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait(40)
        process.stdout.close()


@pytest.fixture(scope="package")
def window(browser_there: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    opened = Browser(tmp_path_factory.mktemp("profile"))
    yield opened
    opened.close()


@pytest.fixture
def browser(window: Browser) -> Iterator[Browser]:
    """The window, at its usual size, with a clean log before and no complaint unheard after."""
    window.unsize()
    window.complaints()
    yield window
    assert window.complaints() == []
