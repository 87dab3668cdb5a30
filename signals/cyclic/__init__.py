"""Second-order cyclostationarity: which bands are modulated, and how fast."""

from signals.cyclic.coherence import CyclicCoherence, cyclic_coherence
from signals.cyclic.envelope import EnhancedEnvelope, enhanced_envelope

__all__ = ["CyclicCoherence", "EnhancedEnvelope", "cyclic_coherence", "enhanced_envelope"]
