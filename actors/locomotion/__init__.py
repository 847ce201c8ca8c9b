"""Walking with real steps: gait, footprints, inverse kinematics and keyframes."""
