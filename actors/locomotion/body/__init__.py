"""The body: lengths of its segments, sizes of people, and which way it faces."""
