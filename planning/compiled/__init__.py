"""How kernels are compiled, and what compiled code keeps between two calls."""
