"""Each command needs one right: the whole table of commands and roles, written out by hand."""

from itertools import pairwise

import pytest

from esplanade.server.accounts.rights import COMMANDS, ROLES, Right, as_text, may, of_text

TABLE = """
command           viewer moderator tuner director admin auditor
set_parameters    -      -         yes   yes      yes   -
clear_parameters  -      -         yes   yes      yes   -
apply_preset      -      -         yes   yes      yes   -
save_preset       -      -         yes   yes      yes   -
delete_preset     -      -         yes   yes      yes   -
set_group         -      -         yes   yes      yes   -
set_behaviour     -      -         yes   yes      yes   -
send_actor        -      -         yes   yes      yes   -
hold_actor        -      -         yes   yes      yes   -
revert            -      -         yes   yes      yes   -
schedule          -      -         yes   yes      yes   -
cancel_schedule   -      -         yes   yes      yes   -
mark              -      -         yes   yes      yes   -
experiment_start  -      -         yes   yes      yes   -
experiment_stop   -      -         yes   yes      yes   -
announce          -      yes       yes   yes      yes   -
mute              -      yes       yes   yes      yes   -
kick              -      yes       yes   yes      yes   -
ban               -      yes       yes   yes      yes   -
unban             -      yes       yes   yes      yes   -
warn              -      yes       yes   yes      yes   -
walk_out          -      yes       yes   yes      yes   -
hide_line         -      yes       yes   yes      yes   -
slow_mode         -      yes       yes   yes      yes   -
word_filter       -      yes       yes   yes      yes   -
quiet_zone        -      yes       yes   yes      yes   -
settle_report     -      yes       yes   yes      yes   -
add_actors        -      -         -     yes      yes   -
remove_actors     -      -         -     yes      yes   -
move_door         -      -         -     yes      yes   -
pace              -      -         -     yes      yes   -
record            -      -         -     yes      yes   -
user_add          -      -         -     -        yes   -
user_remove       -      -         -     -        yes   -
user_role         -      -         -     -        yes   -
user_password     -      -         -     -        yes   -
token_add         -      -         -     -        yes   -
token_revoke      -      -         -     -        yes   -
"""
HEAD, *LINES = [line.split() for line in TABLE.strip().splitlines()]


def test_the_table_names_every_command_and_role() -> None:
    assert {line[0] for line in LINES} == set(COMMANDS)
    assert HEAD[1:] == list(ROLES)


@pytest.mark.parametrize("role", HEAD[1:])
@pytest.mark.parametrize("line", LINES, ids=lambda line: line[0])
def test_a_command_is_for_these_roles(line: list[str], role: str) -> None:
    command, *answers = line
    assert may(ROLES[role], command) is (answers[HEAD.index(role) - 1] == "yes")


def test_nothing_suffices_for_a_command_that_is_not_known() -> None:
    assert not may(frozenset(Right), "set_paramters")


def test_no_rights_suffice_for_nothing() -> None:
    assert not any(may(frozenset(), command) for command in COMMANDS)


def test_each_role_up_to_admin_has_the_rights_of_the_one_before() -> None:
    in_order = [ROLES[role] for role in ("viewer", "moderator", "tuner", "director", "admin")]
    assert all(less < more for less, more in pairwise(in_order))
    assert ROLES["admin"] == frozenset(Right)
    assert ROLES["auditor"] == {Right.WATCH, Right.AUDIT}
    assert [role for role in ROLES if Right.AUDIT in ROLES[role]] == ["admin", "auditor"]


def test_every_right_but_watching_and_auditing_is_for_some_command() -> None:
    assert set(Right) - set(COMMANDS.values()) == {Right.WATCH, Right.AUDIT}


def test_rights_come_back_from_text_and_unknown_ones_give_none() -> None:
    for rights in ROLES.values():
        assert of_text(as_text(rights)) == rights
    assert of_text("watch rule_the_world") == {Right.WATCH}
    assert of_text("") == frozenset()
