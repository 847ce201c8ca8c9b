"""The audit: who did what and when, in rows that are added only, each with the hash of the last.

It knows the store and nothing else of the server.
"""
