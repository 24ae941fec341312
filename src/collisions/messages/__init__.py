"""What a caller is told: errors, hints at what to write, warnings and progress."""
