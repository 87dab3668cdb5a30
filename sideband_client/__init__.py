"""Python client of a Sideband server.

    import sideband_client

    with sideband_client.connect("http://127.0.0.1:8000") as client:
        job = client.simulate("paper-demo", set={"fit_clearance@bearing1.gap": 2e-5}, duration_s=2.0)
        result = job.wait(progress=print).result()
        signals = result.signals()

It needs httpx and NumPy and nothing of the server's own code. Errors: `sideband_client.errors`.
"""

from sideband_client.client import Client, connect
from sideband_client.data import Channel, Signals, Spectrum
from sideband_client.dataset import Dataset
from sideband_client.errors import ClientError
from sideband_client.job import Job
from sideband_client.reconciliation import Reconciliation
from sideband_client.result import Result
from sideband_client.state import JobState, Progress
from sideband_client.transport import Timing

__all__ = [
    "Channel",
    "Client",
    "ClientError",
    "Dataset",
    "Job",
    "JobState",
    "Progress",
    "Reconciliation",
    "Result",
    "Signals",
    "Spectrum",
    "Timing",
    "connect",
]
