"""One question each, asked beside the headline: what a part costs, and whether it is right."""
