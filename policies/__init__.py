"""Policies from outside: somebody's own class, in a process that has only what it may see.

A policy is a class with one method, `velocity`; see `interface.Velocities`. It is named by its file
or module and its name there, `my_policy.py:MyPolicy`, or by an entry point of the group
`esplanade.policies`.
"""
