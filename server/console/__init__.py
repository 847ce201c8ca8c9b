"""The console carries out what operators want of a running world, by every way in.

It knows the world, the audit and accounts. It knows no sessions of people.
"""
