"""Scripts to read and to start from."""
