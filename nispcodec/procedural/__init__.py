"""Assets made on the spot, for demonstrations and tests."""
