"""The arms that the web client is tested with reach as ours do."""

from tests.browser import reach_vectors


def test_the_stored_vectors_are_up_to_date() -> None:
    stored = reach_vectors.FIXTURE.read_text(encoding="utf-8")
    assert stored == reach_vectors.text(), "run: python -m tests.browser.reach_vectors"
