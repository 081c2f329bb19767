"""Labeled points to learn from."""
