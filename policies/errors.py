"""Errors of policies."""


class PolicyError(Exception):
    """A policy cannot be used here; the message says why, and what helps."""


class PolicyFaultError(Exception):
    """A policy failed in the middle of an episode, which ends; the message says how."""
