"""The training step in torch."""
