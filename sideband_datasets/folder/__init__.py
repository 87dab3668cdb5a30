"""A dataset as a folder: shards made by workers, a manifest, a card; checked, and taken up again where it stopped."""

from sideband_datasets.folder.finding import Finding
from sideband_datasets.folder.layout import unfinished
from sideband_datasets.folder.make import Progress, Settings, check_size, make, resume
from sideband_datasets.folder.space import free_bytes
from sideband_datasets.folder.verify import verify

__all__ = ["Finding", "Progress", "Settings", "check_size", "free_bytes", "make", "resume", "unfinished", "verify"]
