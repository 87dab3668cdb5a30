"""Geometry to numbers: gears, bearings, shafts."""
