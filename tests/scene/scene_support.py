"""What the tests of the scene description share."""

from hypothesis import settings

STEADY = settings(max_examples=50, deadline=None, derandomize=True)
"""The same examples in every run, however slow the machine is."""
