"""Everything from one command: broker, workers, HTTP; and down again in the right order."""

from __future__ import annotations

import errno
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from types import FrameType

import httpx
import uvicorn
from fastapi import FastAPI

from app.demo import submit_demo, wait_for_demo
from app.settings import Settings, settings_for_everything
from app.supervise import Supervisor
from app.wiring import application
from sim.core.errors import Problem, SidebandError, SpecError
from store.settings import StoreSettings
from store.stores import open_stores

HTTP_GRACE_S = 3
WORKER_GRACE_S = 5.0
BROKER_STOP_S = 15.0


class BrokerUnavailable(SidebandError):
    """The embedded broker did not start."""


def _say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def _say_where(url: str) -> None:
    _say(f"Sideband is at {url}")


@dataclass(frozen=True, kw_only=True)
class Service:
    """What to serve. `build` and `worker_command` are replaced in tests."""

    settings: Settings
    workers: int
    open_browser: bool = False
    demo: bool = False
    build: Callable[[Settings], FastAPI] = application
    worker_command: tuple[str, ...] = (sys.executable, "-m", "workers")
    announce: Callable[[str], None] = _say_where


def serve(
    *,
    host: str = "127.0.0.1",
    port: int = 8000,
    workers: int | None = None,
    data_dir: Path | None = None,
    open_browser: bool = False,
    demo: bool = False,
) -> int:
    """Serve until SIGINT or SIGTERM; what is not given comes from the environment. Returns the exit code."""
    base = settings_for_everything()
    stores = base.stores if data_dir is None else replace(base.stores, data_dir=data_dir.absolute())
    settings = replace(base, host=host, port=port, stores=stores)
    return run(Service(settings=settings, workers=workers or default_workers(), open_browser=open_browser, demo=demo))


def default_workers() -> int:
    """One for each core: a simulation keeps one busy."""
    return max(1, os.cpu_count() or 1)


def run(service: Service) -> int:
    """Start in order (socket, broker, workers, HTTP), stop in the reverse order."""
    service.settings.check()
    stop = threading.Event()
    with (
        _signals(stop),
        _listening(service.settings) as listener,
        _broker(service.settings.stores) as stores,
        _workers(service, stores),
    ):
        settings = replace(service.settings, stores=stores)
        app = service.build(settings)
        server = _Server(
            uvicorn.Config(
                app,
                log_level="warning",
                server_header=False,
                timeout_graceful_shutdown=HTTP_GRACE_S,
                timeout_keep_alive=15,
                lifespan="on",
            )
        )
        threading.Thread(target=_greet, args=(service, server, listener, stop), daemon=True).start()
        if not stop.is_set():
            server.run(sockets=[listener])
            _say("stopping workers and broker; jobs not done yet begin anew when the service starts again")
        return 0 if stop.is_set() else 1


class _Server(uvicorn.Server):
    """Tells streams of events that they end with it."""

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """The request to stop."""
        app = self.config.app
        if isinstance(app, FastAPI):
            app.state.stopping.set()
        super().handle_exit(sig, frame)


@contextmanager
def _signals(stop: threading.Event) -> Iterator[None]:
    """Note the request to stop. The HTTP server handles it first and passes it on to us when it has stopped."""

    def noted(_signal: int, _frame: FrameType | None) -> None:
        stop.set()

    before = {kind: signal.signal(kind, noted) for kind in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for kind, handler in before.items():
            signal.signal(kind, handler)


@contextmanager
def _listening(settings: Settings) -> Iterator[socket.socket]:
    """The port, taken before anything else is started."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    # The protocol is named because asyncio sets TCP_NODELAY only then; without it small replies wait 40 ms for an ACK.
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((settings.host.strip("[]"), settings.port))
    except OSError as error:
        listener.close()
        raise SpecError(_not_listening(settings, error)) from error
    with listener:
        yield listener


def _not_listening(settings: Settings, error: OSError) -> Problem:
    if error.errno == errno.EADDRINUSE:
        message = "is taken by another program, perhaps by another Sideband"
        allowed = f"a free port: `make run PORT={settings.port + 1}`, `sideband serve --port {settings.port + 1}`, or 0"
        return Problem(field="port", message=message, given=settings.port, allowed=allowed)
    if error.errno == errno.EACCES:
        allowed = "1024 to 65535"
        return Problem(field="port", message="needs more rights than you have", given=settings.port, allowed=allowed)
    message = f"cannot be listened on: {error.strerror or error}"
    return Problem(field="host", message=message, given=settings.host, allowed="an address of this machine")


@contextmanager
def _broker(stores: StoreSettings) -> Iterator[StoreSettings]:
    """The stores with a broker: the one in `REDIS_URL`, or an embedded one that lives as long as this block."""
    if stores.redis_url:
        yield stores
        return
    guard = subprocess.Popen(
        [sys.executable, "-m", "workers.broker", str(stores.data_dir / "broker")],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        start_new_session=True,
    )
    assert guard.stdin is not None and guard.stdout is not None
    try:
        line = guard.stdout.readline()
        told: dict[str, str] = json.loads(line) if line else {}
        if "url" not in told:
            raise BrokerUnavailable(told.get("error", "the embedded broker did not start"))
        yield replace(stores, redis_url=told["url"])
    finally:
        guard.stdin.close()
        try:
            guard.wait(BROKER_STOP_S)
        except subprocess.TimeoutExpired:
            guard.kill()
            guard.wait()
        guard.stdout.close()


@contextmanager
def _workers(service: Service, stores: StoreSettings) -> Iterator[None]:
    """The worker processes, kept alive while the block runs."""
    environment = {
        **os.environ,
        "REDIS_URL": stores.redis_url,
        "SIDEBAND_DATA_DIR": str(stores.data_dir),
        "DATABASE_URL": stores.database_url,
        "ARTEFACT_URL": stores.artefact_url,
    }
    opened = open_stores(stores)
    supervisor = Supervisor(
        count=service.workers,
        command=service.worker_command,
        environment=environment,
        stores=opened,
        max_losses=service.settings.max_losses,
        grace_s=WORKER_GRACE_S,
    )
    supervisor.start()
    try:
        yield
    finally:
        supervisor.stop()
        opened.close()


def _greet(service: Service, server: uvicorn.Server, listener: socket.socket, stop: threading.Event) -> None:
    while not server.started:
        if stop.wait(0.02):
            server.should_exit = True
            return
    host, port = listener.getsockname()[:2]
    name = {"0.0.0.0": "localhost", "::": "localhost"}.get(host, f"[{host}]" if ":" in host else host)
    url = f"http://{name}:{port}/"
    service.announce(url)
    data = service.settings.stores.data_dir
    _say(f"{_count(service.workers, 'worker')}; jobs and results are kept in {data}; Ctrl-C stops everything in order")
    if service.open_browser and not service.demo:
        webbrowser.open(url)
    if service.demo:
        _show_demo(service, url, stop)


def _count(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"


def _show_demo(service: Service, url: str, stop: threading.Event) -> None:
    """Submit the demo, say where its result is and when it is there; a failure leaves the service running."""
    if service.settings.keys_required:
        _say(f"no demo: this server asks for API keys; start a simulation at {url}#/new")
        return
    try:
        demo = submit_demo(url)
        if not demo.ready:
            _say(f"simulating the paper's gearbox with a loose bearing (a few seconds): {demo.page}")
        if service.open_browser:
            webbrowser.open(demo.page)
        ended = wait_for_demo(demo, stop)
    except httpx.HTTPError as error:
        _say(f"the demo could not be shown: {error}")
        return
    if ended == "successful":
        _say(f"The demo is ready, open its labelled spectrum: {demo.page}")
    elif ended:
        _say(f"the demo is {ended}: {demo.page} says why")
