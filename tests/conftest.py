"""Settings of the whole suite."""

from hypothesis import settings

# A machine that does other work at the same time fails no test by being slow.
settings.register_profile("nispcodec", deadline=None)
settings.load_profile("nispcodec")
