"""A private PostgreSQL server on a free loopback port, in a folder of its own, gone with the tests."""

from __future__ import annotations

import os
import pwd
import secrets
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PLACES = sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
ACCOUNTS = ("postgres", "nobody")
"""The server refuses to run as root; then it runs as one of these."""


def missing() -> str:
    """Why no server can be started here; empty when one can."""
    absent = [name for name in ("initdb", "postgres") if _program(name) is None]
    if absent:
        return f"PostgreSQL is not installed ({', '.join(absent)} not found; Debian: apt-get install postgresql)"
    if shutil.which("setpriv") is None:
        return "setpriv (util-linux) is needed to start PostgreSQL so that it ends with the tests"
    return ""


def _program(name: str) -> str | None:
    return shutil.which(name, path=os.pathsep.join([*map(str, PLACES), os.environ.get("PATH", "")]))


def _prefix() -> list[str]:
    command = ["setpriv", "--pdeathsig", "INT"]
    if os.geteuid() != 0:
        return command
    account = _account()
    return [*command, f"--reuid={account.pw_uid}", f"--regid={account.pw_gid}", "--clear-groups"]


def _account() -> pwd.struct_passwd:
    known = {entry.pw_name: entry for entry in pwd.getpwall()}
    return next(known[name] for name in ACCOUNTS if name in known)


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextmanager
def cluster() -> Iterator[str]:
    """URL of an empty database, without a driver's name."""
    folder = Path(tempfile.mkdtemp(prefix="sideband-pg-"))
    try:
        password = secrets.token_hex(16)
        (folder / "password").write_text(password)
        if os.geteuid() == 0:
            for path in (folder, folder / "password"):
                os.chown(path, _account().pw_uid, _account().pw_gid)
        _initialise(folder)
        port = _free_port()
        with _server(folder, port):
            yield f"postgresql://sideband:{password}@127.0.0.1:{port}/postgres"
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _initialise(folder: Path) -> None:
    program = _program("initdb")
    assert program is not None
    chosen = ["-U", "sideband", "--auth=scram-sha-256", f"--pwfile={folder / 'password'}", "--no-sync"]
    command = [*_prefix(), program, "-D", str(folder / "data"), *chosen]
    told = subprocess.run(command, cwd="/", capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr


@contextmanager
def _server(folder: Path, port: int) -> Iterator[None]:
    program = _program("postgres")
    assert program is not None
    settings = {"listen_addresses": "127.0.0.1", "port": port, "unix_socket_directories": "", "fsync": "off"}
    chosen = [part for name, value in settings.items() for part in ("-c", f"{name}={value}")]
    with (folder / "log").open("wb") as log:
        command = [*_prefix(), program, "-D", str(folder / "data"), *chosen]
        server = subprocess.Popen(command, cwd="/", stdout=log, stderr=log)
    try:
        _until_ready(server, port, folder / "log")
        yield
    finally:
        # The fast shutdown: a client that lingers must not keep it waiting.
        server.send_signal(signal.SIGINT)
        server.wait(30)


def _until_ready(server: subprocess.Popen[bytes], port: int, log: Path) -> None:
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        if server.poll() is not None:
            break
        if "ready to accept connections" in log.read_text(errors="replace"):
            return
        time.sleep(0.05)
    raise AssertionError(f"PostgreSQL did not start on port {port}: {log.read_text(errors='replace')}")
