"""Independent oracles: slow, simple or deterministic solutions that the engine's results are compared with.

Nothing in this package imports the renderer.
"""
