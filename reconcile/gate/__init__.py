"""Stage 0, the sensor gate: is the mismatch in the measurement?

`inspect_measurement` names what is wrong with recordings as measurements and hands back the best that can be made of
them. It is conservative: a real fault near one bearing raises one channel too, so a change of a channel counts as the
sensor's only where it has the form a machine cannot give it.
"""

from reconcile.gate.findings import FAULTS, Finding, Gate, Kind
from reconcile.gate.gate import inspect_measurement
from reconcile.gate.timing import time_stamp_findings

__all__ = ["FAULTS", "Finding", "Gate", "Kind", "inspect_measurement", "time_stamp_findings"]
