"""What the engine's tests share.

An example may be the first call of a kernel, which is compiled then: that took longer than
Hypothesis allows an example, in an empty cache and beside other programs, and a test failed.
"""

from hypothesis import settings

settings.register_profile("compiled", deadline=None)
settings.load_profile("compiled")
