"""Measurements that the README and the issues quote."""
