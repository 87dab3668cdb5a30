"""Shared vocabulary of the physics: specification, parameters, degrees of freedom, errors, registry."""
