"""Speed, time to error, start-up and memory of AccuRay beside other renderers, in one run.

``python -m benchmarks --help`` lists what can be measured; ``python -m benchmarks.setup_peers`` installs the peers.
"""
