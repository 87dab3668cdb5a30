"""The rules that turn numbers into verdicts."""
