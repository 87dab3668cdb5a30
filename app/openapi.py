"""`python -m app.openapi [--check]`: write the committed OpenAPI document, or compare it with the application."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from fastapi import FastAPI

from app.document import build
from app.handlers import install
from app.main import ROUTERS

SNAPSHOT = Path(__file__).resolve().parents[1] / "openapi" / "openapi.json"


def rendered() -> str:
    """The document of the routes as text, independent of any settings."""
    app = FastAPI()
    for router in ROUTERS:
        app.include_router(router)
    install(app)
    return json.dumps(build(app), indent=1, sort_keys=True, ensure_ascii=False) + "\n"


def main(arguments: list[str]) -> int:
    """Entry point."""
    text = rendered()
    if "--check" in arguments:
        same = SNAPSHOT.is_file() and SNAPSHOT.read_text(encoding="utf-8") == text
        told = "is up to date" if same else "differs from the application: run `python -m app.openapi`"
        sys.stdout.write(f"the OpenAPI document {told}\n")
        return 0 if same else 1
    SNAPSHOT.parent.mkdir(exist_ok=True)
    SNAPSHOT.write_text(text, encoding="utf-8")
    sys.stdout.write(f"wrote {SNAPSHOT}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
