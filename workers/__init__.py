"""RQ entry points, warm-up and the embedded broker."""
