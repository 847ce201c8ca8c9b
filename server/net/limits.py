"""Token buckets limit how much a client may send.

The usual libraries of rate limits keep locks, keys or a store; this runs once for each message.
"""


class TokenBucket:
    """Allows `rate` takes a second for long, and `burst` at once."""

    __slots__ = ("_burst", "_rate", "_then", "_tokens")

    def __init__(self, rate: float, burst: float, now: float) -> None:
        self._rate = rate
        self._burst = self._tokens = burst
        self._then = now

    def available(self, now: float) -> float:
        """The tokens that there are now."""
        self._tokens = min(self._burst, self._tokens + (now - self._then) * self._rate)
        self._then = now
        return self._tokens

    def take(self, now: float, tokens: float = 1.0) -> bool:
        """Take some tokens, one unless told otherwise, if there are so many."""
        if self.available(now) < tokens:
            return False
        self._tokens -= tokens
        return True

    def give(self, now: float, tokens: float) -> None:
        """Give tokens back that were taken in vain."""
        self._tokens = min(self._burst, self.available(now) + tokens)

    def spare(self, now: float, tokens: float, kept: float) -> bool:
        """Take some tokens, if that leaves the given part of a burst."""
        if self.available(now) - tokens < kept * self._burst:
            return False
        self._tokens -= tokens
        return True

    def borrow(self, now: float, tokens: float) -> float:
        """Take tokens, even more than there are, or say how many seconds it is until that may be.

        The result is 0 where they were taken. Whoever takes more than there are leaves a debt,
        and nobody takes anything until the rate has paid it.
        """
        available = self.available(now)
        if available <= 0.0:
            return (1.0 - available) / self._rate
        self._tokens -= tokens
        return 0.0

    def spend(self, now: float, tokens: float) -> None:
        """Take tokens in any case; the debt that they leave is no greater than a burst."""
        self._tokens = max(-self._burst, self.available(now) - tokens)

    def debt_s(self, now: float) -> float:
        """The seconds until the rate has paid a debt; 0 without one."""
        return max(0.0, -self.available(now) / self._rate)

    def is_full(self, now: float) -> bool:
        """Whether the bucket is as good as a new one."""
        return self.available(now) >= self._burst
