"""Walking with real steps: gait, footprints and inverse kinematics, for many avatars at once."""
