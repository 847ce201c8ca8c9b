"""A gateway of a world on several machines: it has the people's connections, and no zone.

For each zone in which people of its are it keeps an audience of the zone's frames, and sends the
zone's host what these people want.
"""
