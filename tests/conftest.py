"""Common settings of every test: reproducible examples, no display."""

from __future__ import annotations

import gc
import os
import sys
from collections import defaultdict
from pathlib import Path

# What collecting makes stays to the end: looking through it for garbage would take a fifth of the time.
gc.disable()

# Before anything loads a linear algebra library: its threads would only wait for those of the other test workers.
TOO_LATE = "numpy" in sys.modules
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

os.environ["MPLBACKEND"] = "Agg"

import pytest  # noqa: E402
from hypothesis import HealthCheck, settings  # noqa: E402

# No deadline: a busy machine must not fail a test. The same examples every time: a red run can be repeated, and more
# of them find nothing new from run to run (`explore` draws others, a thousand of each).
settings.register_profile(
    "house", deadline=None, derandomize=True, max_examples=20, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("explore", deadline=None, max_examples=1000)
settings.register_profile("fast", settings.get_profile("house"), max_examples=15)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "house"))


def pytest_configure(config: pytest.Config) -> None:
    """The fast loop tries fewer examples where a test does not say how many; `make test` tries all."""
    if config.option.markexpr == "not slow" and "HYPOTHESIS_PROFILE" not in os.environ:
        settings.load_profile("fast")


FURTHER = Path(__file__).with_name("further.txt")
"""Tests that `make further` runs, one a line: costlier examples of what `make test` shows by others of that file."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leaves out what is further, unless asked for by `-m further`, a test's name or `-k`; then puts in order."""
    listed = set(FURTHER.read_text(encoding="utf-8").splitlines())
    further = [item for item in items if item.nodeid in listed]
    for item in further:
        item.add_marker(pytest.mark.further)
    if not asked_for(config):
        items[:] = [item for item in items if item.nodeid not in listed]
        lost = sorted({_file(item) for item in further} - {_file(item) for item in items})
        if lost:
            raise pytest.UsageError(f"{FURTHER.name} leaves no test of {', '.join(lost)}")
        config.hook.pytest_deselected(items=further)
    in_order(config, items)


def asked_for(config: pytest.Config) -> bool:
    """Whether further tests run, all or some by name."""
    named = any("::" in str(arg) for arg in config.args) or config.option.keyword
    return bool(named or "further" in config.option.markexpr)


def _file(item: pytest.Item) -> str:
    return item.nodeid.split("::", maxsplit=1)[0]


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """How many the whole run leaves out: processes that share the tests do not say it."""
    if not asked_for(config) and not [arg for arg in config.args if Path(arg).suffix]:
        count = len(FURTHER.read_text(encoding="utf-8").splitlines())
        terminalreporter.write_line(f"{count} further examples are left out (tests/further.txt, make further)")


def in_order(config: pytest.Config, items: list[pytest.Item]) -> None:
    """`make test` hands a file to one process, as what its tests share (brokers, workers, kernels) is dear to make, and
    begins with what takes longest, so that no process is left alone with it at the end."""
    if not getattr(config.option, "loadgroup", False):
        return
    groups: dict[str, list[pytest.Item]] = defaultdict(list)
    for item in items:
        mark = item.get_closest_marker("xdist_group")
        if mark is None:
            item.add_marker(pytest.mark.xdist_group(str(item.path.relative_to(config.rootpath))))
        groups[str(mark.args[0]) if mark else str(item.path)].append(item)
    items[:] = [item for group in sorted(groups.values(), key=_weight, reverse=True) for item in group]


def _weight(group: list[pytest.Item]) -> tuple[bool, int, int]:
    """Long tests, then how many are slow, then how many there are."""
    long, slow = (sum(item.get_closest_marker(name) is not None for item in group) for name in ("long", "slow"))
    return long > 0, slow, len(group)


def pytest_collection_finish(session: pytest.Session) -> None:
    """From here on garbage is collected again, though not looked for among modules and tests."""
    gc.freeze()
    gc.enable()
