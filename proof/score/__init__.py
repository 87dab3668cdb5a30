"""What a report is worth against the truth: case by case, and as rates with intervals."""
