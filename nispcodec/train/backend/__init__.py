"""Backends: each computes training steps in its own way."""
