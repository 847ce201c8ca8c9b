import secrets

from esplanade.server.net.seats import Seats


def test_a_token_finds_its_seat_and_no_other() -> None:
    seats: Seats[str] = Seats()
    ann, ben = seats.issue(1, "Ann", "a", "first"), seats.issue(2, "Ben", "b", "second")
    assert ann != ben
    found = seats.find(ann)
    assert found is not None
    assert (found.avatar_id, found.name) == (1, "Ann")
    assert seats.find(secrets.token_urlsafe(24)) is None
    assert seats.find("\ud800") is None


def test_tokens_are_kept_nowhere_and_shown_nowhere() -> None:
    seats: Seats[str] = Seats()
    token = seats.issue(1, "Ann", "a", "first")
    seat = seats.of(1)
    assert token not in repr(vars(seats))
    assert "digest" not in repr(seat)


def test_taking_a_seat_tells_who_sat_there() -> None:
    seats: Seats[str] = Seats()
    seat = seats.find(seats.issue(1, "Ann", "a", "first"))
    assert seat is not None
    assert seats.occupy(seat, "second", "b") == "first"
    seats.vacate(seat, now=5.0)
    assert seats.occupy(seat, "third", "c") is None
    assert seats.vacant == 0


def test_vacant_seats_are_listed_by_how_long_they_have_been() -> None:
    seats: Seats[str] = Seats()
    all_seats = [seats.find(seats.issue(k, "p", "a", "s")) for k in range(3)]
    for k, seat in enumerate(all_seats):
        assert seat is not None
        seats.vacate(seat, now=float(k))
    assert [seat.avatar_id for seat in seats.vacant_since(1.0)] == [0, 1]
    for seat in seats.vacant_since(1.0):
        seats.remove(seat)
    assert (len(seats), seats.vacant) == (1, 1)
    assert seats.of(0) is None


def test_a_used_token_and_the_new_one_are_valid_until_the_new_one_has_arrived() -> None:
    seats: Seats[str] = Seats()
    first = seats.issue(1, "Ann", "a", "s")
    seat = seats.find(first)
    assert seat is not None
    lost = seats.renew(seat, first)
    second = seats.renew(seat, first)
    assert [seats.find(token) for token in (first, lost, second)] == [seat, None, seat]
    third = seats.renew(seat, second)
    assert [seats.find(token) for token in (first, second, third)] == [None, seat, seat]
    seats.confirm(seat)
    seats.confirm(seat)
    assert [seats.find(token) for token in (second, third)] == [None, seat]
    seats.remove(seat)
    assert seats.find(third) is None


def test_the_longest_vacant_seat_of_the_address_with_most_yields_first() -> None:
    seats: Seats[str] = Seats()
    assert seats.yielding() is None
    for number, address in enumerate(["alone", "crowd", "crowd", "taken", "crowd"]):
        seat = seats.find(seats.issue(number, "p", address, "s"))
        assert seat is not None
        if address != "taken":
            seats.vacate(seat, now=float(number))
    order = []
    while (seat := seats.yielding()) is not None:
        order.append(seat.avatar_id)
        seats.remove(seat)
    assert order == [1, 2, 0, 4]
