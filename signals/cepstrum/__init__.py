"""Cepstra, and editing a signal in its cepstrum."""

from signals.cepstrum.cepstrum import Cepstrum, cepstrum, rahmonic
from signals.cepstrum.lifter import LifterKind, lifter, remove_rahmonics

__all__ = ["Cepstrum", "LifterKind", "cepstrum", "lifter", "rahmonic", "remove_rahmonics"]
