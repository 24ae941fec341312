"""Evidence weighed: the most likely inputs, their posterior distribution, and accounts compared."""
