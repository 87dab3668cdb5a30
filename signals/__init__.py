"""Recordings, spectra, features and labelled peaks."""
