"""What a model of rigid contacts leaves out and a machine has: rolling noise, impulses of others, a free axis."""

from signals.background.axis import free_axis
from signals.background.impulses import Train, knocks, trains
from signals.background.rolling import Carrier, rolling_noise
from signals.background.shown import BANDS, shown_db

__all__ = ["BANDS", "Carrier", "Train", "free_axis", "knocks", "rolling_noise", "shown_db", "trains"]
