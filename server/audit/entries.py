"""Entries and rows of the audit: the same before it is written, and after."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """An act that somebody is about to do, or its outcome.

    `body`, `target`, `command` and `outcome` are kept for ever and are to name no person. What is
    said of people stands in `person`, `note` and `detail`, what is said of the operator in
    `account` and `address`: both can be forgotten later without breaking the chain.
    """

    command: str
    """The name of the command, such as `set_parameters`."""
    account: str | None = None
    """The account that does it; None for the machine itself."""
    role: str = ""
    """The role that the account has at this moment."""
    address: str | None = None
    """The address that the account comes from."""
    target: str = ""
    """The object of the act: the id of an actor, a scope, a door."""
    tick: int | None = None
    """The tick at which it was asked for, or took effect."""
    outcome: str = ""
    """The outcome as one word; empty while it is only about to happen."""
    refers_to: int | None = None
    """The number of the row, of the same writer, whose outcome this is."""
    body: Mapping[str, Any] = field(default_factory=dict)
    """The command itself, with values before and after: JSON."""
    person: str | None = None
    """The name of the person, or of the account, that it is about."""
    note: str | None = None
    """Why, in the words of the operator."""
    detail: Mapping[str, Any] | None = None
    """Further facts about a person: JSON."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Row(Entry):
    """An entry as it stands in the audit."""

    id: int
    """Its place among the rows of all writers."""
    writer: str
    seq: int
    """Its number in its writer's chain, from 1 on."""
    at_us: int
    """When it was written, microseconds since 1970 in UTC; in one chain it never falls."""
    hash: str
