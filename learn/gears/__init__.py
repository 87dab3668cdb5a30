"""Gears: is a tooth of a stage damaged, by what repeats once a turn of either gear at one place of the turn."""
