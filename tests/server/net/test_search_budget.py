"""Searches are charged to a person and to their address."""

import pytest

from esplanade.server.net.fair_queue import Asker
from esplanade.server.net.search_budget import ADDRESS, PERSON, SearchBudget

ANN, BEN = Asker("192.0.2.1", 1), Asker("192.0.2.1", 2)


def test_a_person_who_has_caused_too_much_waits_until_it_is_paid() -> None:
    budget = SearchBudget()
    assert budget.wait_s(ANN, 0.0) == 0.0
    budget.spend(ANN, PERSON.burst_s + 0.05, 0.0)
    assert budget.wait_s(ANN, 0.0) == pytest.approx(0.05 / PERSON.per_s)
    assert budget.wait_s(BEN, 0.0) == 0.0
    assert budget.wait_s(ANN, 0.06 / PERSON.per_s) == 0.0


def test_the_people_of_one_address_share_its_budget() -> None:
    budget = SearchBudget()
    for avatar_id in range(20):
        budget.spend(Asker(ANN.address, avatar_id), 0.25 * ADDRESS.burst_s, 0.0)
    assert budget.wait_s(Asker(ANN.address, 99), 0.0) > 0.0
    assert budget.wait_s(Asker("192.0.2.2", 100), 0.0) == 0.0


def test_a_debt_has_a_bound() -> None:
    budget = SearchBudget()
    budget.spend(ANN, 3600.0, 0.0)
    assert budget.wait_s(ANN, 0.0) == pytest.approx(
        max(PERSON.burst_s / PERSON.per_s, ADDRESS.burst_s / ADDRESS.per_s)
    )


def test_bots_of_this_machine_have_budgets_of_their_own_only() -> None:
    budget = SearchBudget()
    for avatar_id in range(100):
        budget.spend(Asker("127.0.0.1", avatar_id), 1.0, 0.0)
    assert budget.wait_s(Asker("127.0.0.1", 7), 0.0) == 0.0


def test_accounts_that_are_full_again_are_forgotten() -> None:
    budget = SearchBudget()
    for k in range(5000):
        budget.spend(Asker(f"192.0.2.{k}", k), 0.001, float(k))
    assert len(budget) < 2500
