"""The paper's tables, each published number beside ours, and what differs between the two."""
