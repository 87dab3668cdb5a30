"""Files of samples, one reader a format: what arrays a file holds, bounded before anything large is loaded.

Knows nothing of recordings, so that the process that reads a stranger's file (`signals.readers.guard`) starts fast.
"""
