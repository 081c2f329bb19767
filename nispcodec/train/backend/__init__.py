"""What computes a training step."""
