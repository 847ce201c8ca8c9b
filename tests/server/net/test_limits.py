from esplanade.server.net.limits import TokenBucket


def test_a_burst_is_allowed_and_then_the_rate() -> None:
    bucket = TokenBucket(rate=10.0, burst=3, now=0.0)
    assert [bucket.take(0.0) for _ in range(4)] == [True, True, True, False]
    assert not bucket.take(0.05)
    assert bucket.take(0.15)
    assert not bucket.take(0.16)


def test_a_long_silence_saves_up_no_more_than_a_burst() -> None:
    bucket = TokenBucket(rate=10.0, burst=3, now=0.0)
    assert sum(bucket.take(1000.0) for _ in range(10)) == 3


def test_tokens_are_taken_together_or_not_at_all() -> None:
    bucket = TokenBucket(rate=10.0, burst=3, now=0.0)
    assert not bucket.take(0.0, 4.0)
    assert bucket.take(0.0, 3.0)
    assert bucket.available(0.2) == 2.0


def test_a_debt_is_paid_by_the_rate() -> None:
    bucket = TokenBucket(rate=10.0, burst=3, now=0.0)
    assert bucket.borrow(0.0, 13.0) == 0.0
    assert bucket.borrow(0.0, 1.0) == 1.1
    assert not bucket.take(1.0)
    assert bucket.borrow(1.1, 1.0) == 0.0


def test_tokens_that_are_given_back_fill_no_more_than_a_burst() -> None:
    bucket = TokenBucket(rate=10.0, burst=3, now=0.0)
    assert bucket.take(0.0, 2.0)
    bucket.give(0.0, 1.0)
    assert bucket.available(0.0) == 2.0
    bucket.give(0.0, 5.0)
    assert bucket.available(0.0) == 3.0


def test_what_can_be_spared_leaves_a_part_of_the_burst() -> None:
    bucket = TokenBucket(rate=10.0, burst=8, now=0.0)
    assert bucket.spare(0.0, 4.0, kept=0.5)
    assert not bucket.spare(0.0, 1.0, kept=0.5)
    assert bucket.spare(0.1, 1.0, kept=0.5)
    assert bucket.available(0.1) == 4.0
