"""The command line `sideband`."""
