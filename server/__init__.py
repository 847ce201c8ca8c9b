"""The server of a zone: the world that ticks, the sessions of its people, and their one port."""
