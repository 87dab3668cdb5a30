"""The image's recipe, as far as it can be checked without building it: sources, modules, addresses, user, locks."""

from __future__ import annotations

import importlib
import importlib.util
import json
import re
import shlex
from fnmatch import fnmatch
from pathlib import Path

import pytest

from tests.house.project import ROOT, configuration, packages

TEXT = (ROOT / "Dockerfile").read_text(encoding="utf-8")
IGNORE = (ROOT / ".dockerignore").read_text(encoding="utf-8").split()


def instructions() -> list[tuple[str, str]]:
    """Word and argument of each instruction, continued lines joined."""
    lines = [line for line in TEXT.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    joined = re.sub(r"\\\n\s*", "", "\n".join(lines))
    found = [line.partition(" ")[::2] for line in joined.splitlines()]
    return [(word, rest.strip()) for word, rest in found]


def all_of(word: str) -> list[str]:
    return [rest for name, rest in instructions() if name == word]


def environment() -> dict[str, str]:
    return dict(part.split("=", 1) for rest in all_of("ENV") for part in shlex.split(rest))


def copied() -> list[str]:
    """Sources copied from the context."""
    return [source for rest in all_of("COPY") if not rest.startswith("--") for source in rest.split()[:-1]]


def test_every_instruction_is_one_that_exists() -> None:
    known = {"FROM", "WORKDIR", "RUN", "COPY", "ENV", "USER", "VOLUME", "EXPOSE", "STOPSIGNAL", "HEALTHCHECK", "CMD"}
    assert {word for word, _ in instructions()} <= known
    assert instructions()[0][0] == "FROM"


@pytest.mark.parametrize("source", copied())
def test_what_is_copied_exists_and_is_not_ignored(source: str) -> None:
    assert (ROOT / source).exists()
    assert f"!{source}" in IGNORE or f"!{source}/**" in IGNORE


def test_every_room_that_is_installed_is_copied() -> None:
    patterns = configuration()["tool"]["setuptools"]["packages"]["find"]["include"]
    rooms = {room for room in packages() if any(fnmatch(room, pattern) for pattern in patterns)}
    missing = rooms - set(copied())
    assert not missing, "add them to Dockerfile (COPY) and .dockerignore"


def test_locked_versions_are_installed_and_nothing_is_resolved() -> None:
    installs = [rest for rest in all_of("RUN") if "pip install" in rest]
    assert any("-r requirements-server.lock" in rest for rest in installs)
    for rest in installs:
        assert "-r " in rest or "--no-deps" in rest, rest
        assert "--no-cache-dir" in rest, rest
    order = [rest for word, rest in instructions() if word in ("COPY", "RUN")]
    assert order.index("requirements-server.lock ./") < order.index("sim sim"), (
        "code must not renew the packages' layer"
    )


def test_both_stages_have_one_python_that_the_project_takes() -> None:
    stages = all_of("FROM")
    images = {stage.split()[0] for stage in stages}
    assert len(stages) == 2 and len(images) == 1
    (version,) = re.findall(r"^python:(\d+\.\d+)-slim$", images.pop())
    assert f">={version}" == configuration()["project"]["requires-python"]


def test_nothing_runs_as_root_and_the_user_owns_what_it_writes() -> None:
    words = [word for word, _ in instructions()]
    (user,) = all_of("USER")
    made = next(rest for rest in all_of("RUN") if "useradd" in rest)
    assert user == "sideband" and re.search(rf"install -d -o {user} -g {user} ", made)
    assert words.index("USER") < words.index("CMD")
    owned = set(made.split("install -d", 1)[1].split())
    folders = {environment()["SIDEBAND_CACHE"], environment()["SIDEBAND_DATA_DIR"]}
    assert folders <= owned
    assert environment()["MPLCONFIGDIR"].startswith(environment()["SIDEBAND_CACHE"])


def test_kernels_are_compiled_as_the_user_that_runs_them() -> None:
    steps = [f"{word} {rest}" for word, rest in instructions()]
    assert steps.index("USER sideband") < steps.index("RUN python -m workers.warm") < steps.index("VOLUME /data")


def test_keys_are_demanded_as_soon_as_the_port_is_published() -> None:
    command = json.loads(all_of("CMD")[0])
    host = command[command.index("--host") + 1]
    assert host == environment()["SIDEBAND_HOST"] == "0.0.0.0", "the application must know that it is not on loopback"
    assert not [name for name in environment() if re.search("KEY|SECRET|PASSWORD|TOKEN", name)]


def _commands() -> list[list[str]]:
    health = re.sub(r"^.*?CMD ", "", all_of("HEALTHCHECK")[0])
    return [json.loads(all_of("CMD")[0]), json.loads(health), *(shlex.split(rest) for rest in all_of("RUN"))]


def test_every_module_that_is_started_exists() -> None:
    modules = [part[i + 1] for part in _commands() for i, word in enumerate(part[:-1]) if word == "-m"]
    assert "workers.warm" in modules
    for name in modules:
        assert importlib.util.find_spec(name) is not None, name
    module, _, factory = next(
        word for part in _commands() for word in part if ":" in word and "app." in word
    ).partition(":")
    assert callable(getattr(importlib.import_module(module), factory))


def test_code_and_address_of_the_health_check_are_real() -> None:
    (code,) = [part[part.index("-c") + 1] for part in _commands() if "-c" in part]
    compile(code, "HEALTHCHECK", "exec")
    (path,) = re.findall(r"127\.0\.0\.1:8000(/\w+)", code)
    routes = Path(ROOT / "app" / "routes" / "health.py").read_text(encoding="utf-8")
    assert f'"{path}"' in routes
    assert all_of("EXPOSE") == ["8000"]


def test_options_of_the_server_are_its_own() -> None:
    uvicorn = importlib.import_module("uvicorn.main")
    known = {option for parameter in uvicorn.main.params for option in (*parameter.opts, *parameter.secondary_opts)}
    command = json.loads(all_of("CMD")[0])
    assert command[0] == "uvicorn" and {word for word in command if word.startswith("--")} <= known
