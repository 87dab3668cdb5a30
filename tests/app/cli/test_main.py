"""The command table: lazy loading, errors without tracebacks, exit codes."""

from __future__ import annotations

import importlib
import subprocess
import sys
from collections.abc import Callable

import pytest

from app.cli.main import COMMANDS, main

Call = Callable[..., tuple[int, str, str]]


def test_every_command_has_its_module() -> None:
    for command in COMMANDS.values():
        module = importlib.import_module(command.module)
        assert callable(module.configure)
        assert callable(module.run)
        assert module.__doc__


@pytest.mark.slow
def test_physics_commands_load_no_web_and_no_broker() -> None:
    """In one process, one after another: what a command loads is told at it or at none."""
    commands = ("simulate", "machine", "verify", "mesh")
    code = (
        "import sys\nfrom app.cli.main import main\n"
        f"for command in {commands!r}:\n"
        "    try: main([command, '--help'])\n"
        "    except SystemExit: pass\n"
        "    print(command, sorted({'fastapi', 'uvicorn', 'redis', 'rq'} & set(sys.modules)), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr.splitlines() == [f"{command} []" for command in commands]
    assert all(f"sideband {command}" in done.stdout for command in commands)


def test_unknown_command_is_named_with_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["simulat"])
    assert stop.value.code == 2
    error = capsys.readouterr().err
    assert "simulat" in error
    assert "simulate" in error


def test_no_command_lists_them(call: Call) -> None:
    code, _, error = call()
    assert code == 2
    assert all(name in error for name in COMMANDS)


def test_version(call: Call) -> None:
    code, out, _ = call("--version")
    assert code == 0
    assert out.startswith("sideband ")


def test_interrupt_is_no_traceback(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(_: object) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr("app.cli.presets.run", interrupted)
    code, _, error = call("presets")
    assert code == 130
    assert error == "interrupted\n"


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("presets", "no-such"), ("no-such", "paper-demo")),
        (("terms", "no_such"), ("no_such", "fit_clearance")),
        (("bearings", "99999"), ("99999",)),
        (("mesh", "--preset", "oscillator"), ("meshes", "oscillator")),
        (("mesh", "--mesh", "mesh9"), ("mesh9", "mesh1")),
        (("serve", "--port", "99999"), ("--port", "65535")),
        (("serve", "--workers", "0"), ("--workers", "1 to")),
        (("verify", "/no/such/folder"), ("/no/such/folder",)),
        (("machine", "--check", "/no/such/file"), ("/no/such/file",)),
    ],
)
def test_wrong_input_is_named_and_exits_2(call: Call, arguments: tuple[str, ...], named: tuple[str, ...]) -> None:
    code, out, error = call(*arguments)
    assert code == 2
    assert out == ""
    assert error.startswith("error: ")
    assert all(word in error for word in named)
