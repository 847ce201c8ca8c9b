"""Many sockets at once: the usual traffic goes around the event loop, all else through it.

Both directions are options. Without them, and for connections that are not plain sockets of Linux,
the event loop's transports do the same, byte by byte.
"""
