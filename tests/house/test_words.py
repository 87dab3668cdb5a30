"""No address of a machine or registry, no link or file name that leads nowhere."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.house.project import ROOT, text, tracked

REGISTRY = re.compile(r"https?://[^ )\"']+/(?:simple|packages|pool)/|files\.python" + r"hosted\.org")
HOME = re.compile(r"(?<![\w.~-])/(?:home|root|Users|work)/[\w.-]+")
LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)|!\[[^\]]*\]\(([^)\s]+)\)")
PAGE = re.compile(r"\bdocs/[\w./-]+\.(?:md|png)\b")


def _hits(pattern: re.Pattern[str], suffixes: set[str] | None = None) -> list[str]:
    return [
        f"{name}: {found.group(0)}"
        for name in tracked()
        if (suffixes is None or name.suffix in suffixes) and (content := text(name)) is not None
        for found in pattern.finditer(content)
    ]


def test_no_registry_address_is_committed():
    assert not _hits(REGISTRY)


@pytest.mark.slow
def test_no_path_of_one_machine_is_committed():
    # Dockerfiles may name the folders of the image they build.
    assert not [hit for hit in _hits(HOME) if not hit.startswith(("Dockerfile", "docker-compose"))]


def _target(page: Path, link: str) -> Path | None:
    path = link.partition("#")[0]
    if not path or re.match(r"[a-z]+:", path):
        return None
    return (ROOT / page).parent / path


def test_links_between_pages_lead_somewhere():
    lost = []
    for name in tracked():
        if name.suffix != ".md":
            continue
        for found in LINK.finditer(text(name) or ""):
            link = found.group(1) or found.group(2)
            target = _target(name, link)
            if target is not None and not target.exists():
                lost.append(f"{name}: {link}")
    assert not lost


def test_pages_named_in_the_code_exist():
    lost = [
        f"{name}: {page}"
        for name in tracked()
        if name.suffix in {".py", ".toml", ".html", ".js"} and "tests" not in name.parts
        for page in PAGE.findall(text(name) or "")
        if not (ROOT / page).is_file()
    ]
    assert not lost
