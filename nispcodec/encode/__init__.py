"""An asset in, a model out."""
