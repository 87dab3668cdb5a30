"""Stage 0: recordings become features that need no absolute phase and no calibrated sensor."""
