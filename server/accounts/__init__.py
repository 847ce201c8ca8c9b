"""Accounts of operators: who they are, what they may do, and how they show that it is they.

It knows the store and the audit. It knows no network: cookies, headers and addresses are made of
this elsewhere.
"""
