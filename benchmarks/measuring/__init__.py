"""How a number is taken: time and memory, the machine it was on, what was asked of it."""
