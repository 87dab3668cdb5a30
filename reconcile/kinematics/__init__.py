"""Reconcile at the level of kinematics: bearing sizes, shaft speeds and teeth are known, the machine is not."""

from reconcile.kinematics.described import described_kinematics
from reconcile.kinematics.reconcile import reconcile_kinematics
from reconcile.kinematics.spec import KinematicSpec, of_machine, read_kinematic_spec

__all__ = ["KinematicSpec", "described_kinematics", "of_machine", "read_kinematic_spec", "reconcile_kinematics"]
