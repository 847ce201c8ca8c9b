"""The gait: joint angles over a cycle, and length and duration of a step."""
