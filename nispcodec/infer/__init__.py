"""Networks evaluated in numpy."""
