"""Where assets are encoded: processes of this machine, or the tasks of a Ray cluster."""
