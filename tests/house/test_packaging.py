"""Lock files agree with the declared dependencies; what they hold may be shipped."""

from __future__ import annotations

import importlib.metadata as installed
import re
from fnmatch import fnmatch
from functools import cache
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.house.project import ROOT, configuration, tracked

LOCKS = ("requirements.lock", "requirements-server.lock", "requirements-dev.lock")
RUN, SERVER, DEV = LOCKS
SERVER_EXTRAS = ("postgres", "s3", "formats")
"""What the image installs besides: other stores than the folder and SQLite, further formats of recordings."""
COPYLEFT = re.compile(r"\bA?GPL|GNU (?:Affero )?General Public", re.IGNORECASE)


@cache
def locked(name: str) -> dict[str, Requirement]:
    """Requirements of a lock file by canonical name."""
    lines = (ROOT / name).read_text(encoding="utf-8").splitlines()
    wanted = [Requirement(line) for line in lines if line.strip() and not line.lstrip().startswith("#")]
    return {canonicalize_name(item.name): item for item in wanted}


def _declared(*extras: str) -> list[Requirement]:
    project = configuration()["project"]
    listed = list(project["dependencies"])
    for extra in extras:
        listed += project["optional-dependencies"][extra]
    return [Requirement(line) for line in listed]


def _package(name: Path) -> Path:
    return next(folder for folder in name.parents if (ROOT / folder / "__init__.py").is_file())


def test_data_files_are_installed_with_their_package():
    patterns = configuration()["tool"]["setuptools"]["package-data"]
    included = configuration()["tool"]["setuptools"]["packages"]["find"]["include"]
    rooms = {pattern.removesuffix("*") for pattern in included}
    data = [name for name in tracked() if name.parts[0] in rooms and name.suffix != ".py"]
    assert data
    for name in data:
        package = _package(name)
        chosen = patterns["*"] + patterns.get(".".join(package.parts), [])
        rest = str(name.relative_to(package))
        assert any(fnmatch(rest, pattern) for pattern in chosen), f"{name} would not be installed"


@pytest.mark.parametrize(
    ("lock", "extras"), [(RUN, ()), (SERVER, SERVER_EXTRAS), (DEV, (*SERVER_EXTRAS, "mdf", "dev"))]
)
def test_every_declared_dependency_is_locked_to_one_allowed_version(lock, extras):
    pins = locked(lock)
    for wanted in _declared(*extras):
        pin = pins.get(canonicalize_name(wanted.name))
        assert pin is not None, f"{wanted.name} is not in {lock}: run `make lock`"
        (version,) = [part.version for part in pin.specifier if part.operator == "=="]
        assert wanted.specifier.contains(version), f"{wanted} against {version} in {lock}: run `make lock`"


def test_everything_locked_is_pinned_by_name():
    for lock in LOCKS:
        for name, pin in locked(lock).items():
            assert pin.url is None, f"{name} comes from an address"
            assert [part.operator for part in pin.specifier] == ["=="], f"{name} is not pinned in {lock}"


def test_developers_test_the_versions_that_run():
    developed = locked(DEV)
    for lock in (RUN, SERVER):
        pins = locked(lock).items()
        assert not {name for name, pin in pins if str(developed[name].specifier) != str(pin.specifier)}, lock


def _licence(name: str) -> str:
    data = installed.metadata(name)
    classifiers = [line for line in data.get_all("Classifier", []) if line.startswith("License")]
    stated = data.get("License-Expression") or " ".join([*classifiers, (data.get("License") or "")[:120]])
    return str(stated)


@pytest.mark.slow
def test_no_dependency_is_under_the_gpl():
    present = {dist.name: dist.version for dist in installed.distributions()}
    known = {canonicalize_name(name) for name in present}
    names = [name for name in locked(DEV) if name in known]
    assert len(names) > 0.8 * len(locked(DEV)), "the locked packages are not the installed ones"
    offending = {name: _licence(name) for name in names if COPYLEFT.search(_licence(name).replace("LGPL", ""))}
    assert not offending


def test_the_licence_is_whole_and_what_is_copied_here_has_a_notice():
    licence = (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert "Apache License" in licence
    assert "END OF TERMS AND CONDITIONS" in licence
    notices = (ROOT / "THIRD_PARTY_NOTICES.md").read_text(encoding="utf-8")
    for folder in {name.parent for name in tracked() if "vendor" in name.parts or name.name.startswith("NOTICE")}:
        assert str(folder) in notices, f"{folder} holds others' work and is not in THIRD_PARTY_NOTICES.md"
