"""`make sim2real`: trained on simulations only, tested on measured recordings."""
