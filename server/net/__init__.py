"""Everything that waits: listener, sessions, outboxes, the ticker. All of asyncio lives here."""
