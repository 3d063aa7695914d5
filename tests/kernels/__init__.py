"""Tests of the kernels beyond the processor of this machine."""
