"""Labelled peaks: predicted families, identities between sums, matching, and the JSON form."""

from signals.labels.canonical import Candidate, merge_lines
from signals.labels.families import Bound, kinematic_lines
from signals.labels.kinematics import BearingKinematics, Kinematics, MeshKinematics, ShaftKinematics
from signals.labels.match import label_peaks
from signals.labels.types import LabelledPeak, LabelSet, Matching, Status

__all__ = [
    "BearingKinematics",
    "Bound",
    "Candidate",
    "Kinematics",
    "LabelSet",
    "LabelledPeak",
    "Matching",
    "MeshKinematics",
    "ShaftKinematics",
    "Status",
    "kinematic_lines",
    "label_peaks",
    "merge_lines",
]
