import secrets

from esplanade.server.net.seats import Seats


def test_a_token_finds_its_seat_and_no_other() -> None:
    seats: Seats[str] = Seats()
    ann, ben = seats.issue(1, "Ann", "first"), seats.issue(2, "Ben", "second")
    assert ann != ben
    found = seats.find(ann)
    assert found is not None
    assert (found.avatar_id, found.name) == (1, "Ann")
    assert seats.find(secrets.token_urlsafe(24)) is None
    assert seats.find("\ud800") is None


def test_tokens_are_kept_nowhere_and_shown_nowhere() -> None:
    seats: Seats[str] = Seats()
    token = seats.issue(1, "Ann", "first")
    seat = seats.of(1)
    assert token not in repr(vars(seats))
    assert "digest" not in repr(seat)


def test_taking_a_seat_tells_who_sat_there() -> None:
    seats: Seats[str] = Seats()
    seat = seats.find(seats.issue(1, "Ann", "first"))
    assert seat is not None
    assert seats.occupy(seat, "second") == "first"
    seats.vacate(seat, now=5.0)
    assert seats.occupy(seat, "third") is None
    assert seats.vacant == 0


def test_vacant_seats_are_listed_by_how_long_they_have_been() -> None:
    seats: Seats[str] = Seats()
    all_seats = [seats.find(seats.issue(k, "p", "s")) for k in range(3)]
    for k, seat in enumerate(all_seats):
        assert seat is not None
        seats.vacate(seat, now=float(k))
    assert [seat.avatar_id for seat in seats.vacant_since(1.0)] == [0, 1]
    for seat in seats.vacant_since(1.0):
        seats.remove(seat)
    assert (len(seats), seats.vacant) == (1, 1)
    assert seats.of(0) is None
