"""The commands that decide whether a change is one for the better."""
