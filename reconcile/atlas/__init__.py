"""What each candidate effect would change on this machine: simulated signatures, made once and cached."""
