"""A host of a world on several machines: it claims a zone, simulates it, and says what happens.

The people's clients are at gateways. Nothing here knows a socket of theirs.
"""
