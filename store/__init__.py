"""The only code that touches disk, databases, object stores or the broker."""
