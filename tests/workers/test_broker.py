"""The embedded broker under its guard: one to a folder, never orphaned, restarted, persistent."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest
from redis import Redis
from redis.exceptions import AuthenticationError, RedisError

from tests.service.parts import ROOT, eventually, start_broker, stop_broker


def server_of(guard: subprocess.Popen[str]) -> psutil.Process:
    return next(c for c in psutil.Process(guard.pid).children() if "valkey" in c.name())


@pytest.mark.slow
def test_settings_that_keep_accepted_work(tmp_path: Path) -> None:
    guard, url = start_broker(tmp_path)
    try:
        client = Redis.from_url(url, decode_responses=True)
        wanted = {"maxmemory-policy": "noeviction", "appendonly": "yes", "bind": "127.0.0.1", "protected-mode": "yes"}
        for name, value in wanted.items():
            assert client.config_get(name) == {name: value}
        assert url.split(":")[2].split("@")[0] not in " ".join(server_of(guard).cmdline())
        port = url.rsplit(":", 1)[1].split("/")[0]
        with pytest.raises(AuthenticationError):
            Redis(host="127.0.0.1", port=int(port)).ping()
        client.close()
    finally:
        stop_broker(guard)


@pytest.mark.slow
def test_data_survive_a_stop_and_a_second_server_is_refused(tmp_path: Path) -> None:
    guard, url = start_broker(tmp_path)
    Redis.from_url(url).set("kept", "yes")
    second = subprocess.run(
        [sys.executable, "-m", "workers.broker", str(tmp_path)],
        stdin=subprocess.PIPE,
        capture_output=True,
        text=True,
        cwd=ROOT,
        timeout=20,
        check=False,
    )
    assert second.returncode == 1 and "in use" in json.loads(second.stdout)["error"]
    stop_broker(guard)
    guard, url = start_broker(tmp_path)
    try:
        assert Redis.from_url(url).get("kept") == b"yes"
    finally:
        stop_broker(guard)


@pytest.mark.slow
def test_killed_owner_leaves_no_orphan(tmp_path: Path) -> None:
    code = (
        "import subprocess, sys, time\n"
        f"p = subprocess.Popen([sys.executable, '-m', 'workers.broker', {str(tmp_path)!r}], stdin=subprocess.PIPE)\n"
        "time.sleep(60)\n"
    )
    owner = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, cwd=ROOT)
    assert owner.stdout is not None
    owner.stdout.readline()
    everyone = psutil.Process(owner.pid).children(recursive=True)
    assert len(everyone) == 2
    owner.kill()
    owner.wait()
    owner.stdout.close()
    eventually(lambda: not any(p.is_running() and p.status() != "zombie" for p in everyone))


@pytest.mark.slow
def test_killed_guard_takes_the_server_along(tmp_path: Path) -> None:
    guard, _ = start_broker(tmp_path)
    server = server_of(guard)
    os.kill(guard.pid, signal.SIGKILL)
    guard.wait()
    assert guard.stdin is not None and guard.stdout is not None
    guard.stdin.close()
    guard.stdout.close()
    eventually(lambda: not server.is_running() or server.status() == "zombie")


@pytest.mark.slow
def test_killed_server_comes_back_on_the_same_address(tmp_path: Path) -> None:
    guard, url = start_broker(tmp_path)
    try:
        client = Redis.from_url(url)
        client.set("kept", "yes")
        client.execute_command("WAITAOF", 1, 0, 2000)
        before = server_of(guard)
        before.kill()

        def back() -> bool:
            try:
                return client.get("kept") == b"yes"
            except RedisError:
                return False

        eventually(back)
        assert server_of(guard).pid != before.pid
    finally:
        stop_broker(guard)


@pytest.mark.slow
def test_unreadable_file_is_set_aside(tmp_path: Path) -> None:
    guard, url = start_broker(tmp_path)
    Redis.from_url(url).set("a", "b")
    stop_broker(guard)
    for path in (tmp_path / "appendonlydir").iterdir():
        path.write_bytes(b"nonsense\n" * 100)
    guard, url = start_broker(tmp_path)
    try:
        assert Redis.from_url(url).dbsize() == 0
        assert len(list(tmp_path.glob("unreadable-*"))) == 1
    finally:
        stop_broker(guard)


@pytest.mark.slow
def test_ctrl_c_is_for_the_owner_to_handle(tmp_path: Path) -> None:
    guard, url = start_broker(tmp_path)
    try:
        os.kill(guard.pid, signal.SIGINT)
        assert Redis.from_url(url).ping()
        assert guard.poll() is None
    finally:
        stop_broker(guard)
