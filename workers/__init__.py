"""Worker processes: RQ entry points, warm-up, the embedded broker.

A worker computes on one core: the number of workers sets how many cores are used. Linear algebra in several threads
would make workers wait for each other (small matrices: many times slower on a busy machine) and could change the last
bits of a result. The libraries read these settings once, when they are loaded, so they are set before anything else.
"""

import os

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
