"""The compiling of kernels, and the data that compiled code keeps between two calls."""
