"""A bridge from an Esplanade world to ROS 2."""
