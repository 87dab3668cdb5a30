"""Training data: machines drawn over wide ranges, simulated with and without a fault, heard through a drawn chain."""
