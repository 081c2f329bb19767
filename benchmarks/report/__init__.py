"""One HTML file with everything a run found."""
