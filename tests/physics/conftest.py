"""Settings of the engine's tests.

An example may be the first call of a kernel, which is then compiled. With an empty cache and beside
other programs that took longer than Hypothesis allows for an example, and a test failed.
"""

from hypothesis import settings

settings.register_profile("compiled", deadline=None)
settings.load_profile("compiled")
