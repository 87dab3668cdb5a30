"""Made rigs of which only a drawing is known: motors and gearboxes with other numbers each, and what is hidden there.

Signals, not a machine: impacts through resonances, mesh lines that a tooth modulates, a speed that wanders. Uses
nothing of the product but its command line. `python -m proof.made` runs them and writes the page.
"""
