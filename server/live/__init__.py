"""Live views: what operators see of a running world, made beside the zone and not by it.

The zone's loop hands each tick over (`tap`); the thread of the private port makes of it what
subscribers and questions want. It knows the world and accounts, and neither console nor network.
"""
