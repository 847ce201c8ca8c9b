"""The frames that the web client is tested with are those that this protocol makes."""

from tests.browser import wire_vectors


def test_the_stored_vectors_are_up_to_date() -> None:
    stored = wire_vectors.FIXTURE.read_text(encoding="utf-8")
    assert stored == wire_vectors.text(), "run: python -m tests.browser.wire_vectors"
