"""Moderation that is kept: bans, reports, rules of chat, and lines, without any network or world.

`server/net/moderation.py` holds people to it, and `server/console/people.py` changes it.
"""
