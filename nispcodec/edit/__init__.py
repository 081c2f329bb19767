"""Changes to an asset or a file that need no training."""
