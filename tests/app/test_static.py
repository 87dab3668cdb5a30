"""A folder of static files at `/` does not hide the interface, nor its errors."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.service.parts import LiveServer, Parts


@pytest.mark.slow
def test_static_files_beside_the_interface(parts: Parts, tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("<!doctype html><title>Sideband</title>", encoding="utf-8")
    with LiveServer(parts.app(static_folder=tmp_path)) as client:
        page = client.get("/")
        assert page.status_code == 200 and "Sideband" in page.text
        assert "default-src 'self'" in page.headers["Content-Security-Policy"]
        assert client.get("/v1/presets").status_code == 200
        for path in ("/nothing.html", "/v1/nothing", "/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd"):
            reply = client.get(path)
            assert reply.status_code == 404, path
            assert reply.headers["Content-Type"] == "application/problem+json"
        assert client.get("/openapi.json").json()["info"]["title"] == "Sideband"
