"""What a description says of its machine, checked before the data is looked at."""

from __future__ import annotations

from reconcile.kinematics import described_kinematics
from reconcile.kinematics.families import ties
from signals.ingest import Description


def check_kinematics(description: Description) -> None:
    """SpecError for a bearing that is not known or cannot be, and for a shaft that the kinematics do not have."""
    spec = described_kinematics(description)
    if spec is not None and description.operating is not None:
        ties(spec, description.operating.shaft)
