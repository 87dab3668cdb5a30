"""Common settings of every test: reproducible examples, no display."""

from __future__ import annotations

import os

# Before anything loads a linear algebra library: its threads would only wait for those of the other test workers.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

import matplotlib as mpl  # noqa: E402
from hypothesis import HealthCheck, settings  # noqa: E402

mpl.use("Agg")

# No deadline: a busy machine must not fail a test. The same examples every time: a red run can be repeated.
settings.register_profile("house", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("explore", deadline=None, max_examples=1000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "house"))
