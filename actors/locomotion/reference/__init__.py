"""Reference only: the published gait, and poses for films and tests. The server imports none."""
