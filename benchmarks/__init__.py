"""Measurements that the README and the decision records quote."""
