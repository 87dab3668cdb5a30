"""Common settings of every test: reproducible examples, no display, a browser where CI promises one."""

from __future__ import annotations

import os
import shutil

import matplotlib as mpl
import pytest
from hypothesis import HealthCheck, settings

mpl.use("Agg")

# No deadline: a busy machine must not fail a test. The same examples every time: a red run can be repeated.
settings.register_profile("house", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("explore", deadline=None, max_examples=1000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "house"))


def _in_ci() -> bool:
    return os.environ.get("CI", "").lower() not in {"", "0", "false"}


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip a browser test without a browser, except where there must be one."""
    if item.get_closest_marker("browser") is None:
        return
    missing = [name for name in ("chromium", "chromedriver") if shutil.which(name) is None]
    if missing:
        message = f"{' and '.join(missing)} not found: run `make browser` as root, or install them"
        (pytest.fail if _in_ci() else pytest.skip)(message)
