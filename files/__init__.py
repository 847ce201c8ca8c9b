"""The one way to open files: up to a bound, unpacked, and decoded by what they say."""
