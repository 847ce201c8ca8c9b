"""The kernels of reacting people."""
