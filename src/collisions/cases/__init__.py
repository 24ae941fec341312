"""Case files: read, answered and described by a schema."""
