"""What operators do with a running world, whichever way they come in.

It knows the world, the audit and accounts. It knows no sessions of people.
"""
