"""Names that the parts of a dataset's way share."""

from __future__ import annotations

DATASET = "dataset"
"""Kind of these jobs; they hold no ticket themselves."""
SHARD = "dataset-shard"
"""Kind of the jobs that make one shard each."""
ASSEMBLY = "dataset-assembly"
"""Kind of the job that describes what the shards hold, after the last of them."""
PARTS = (SHARD, ASSEMBLY)
METHOD_VERSION = "dataset-4"
"""Part of a dataset's identity beside the versions of what makes its rows."""
HELD = 253_402_300_799.0
"""The year 9999: what waits for other jobs is not due before it is released."""
