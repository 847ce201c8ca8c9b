from tests.server.worlds import FIELD, Trial


def test_tables_grow_with_viewers_and_what_each_sees_not_with_the_zone() -> None:
    """A table of everyone by everyone would take 400 MB."""
    trial = Trial(scene=FIELD, max_people=10_000, view_limit=100)
    trial.join(*((50.0 + k, 50.0) for k in range(20)))
    views = trial.audience._interest.views
    assert sum(one.nbytes for one in views) < 20 * 2 * 101 * 16
