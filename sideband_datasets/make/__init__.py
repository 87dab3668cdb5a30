"""Rows of a plan: simulated in lanes, measured, cut, labelled."""

from sideband_datasets.make.batch import Failure
from sideband_datasets.make.stream import rows

__all__ = ["Failure", "rows"]
