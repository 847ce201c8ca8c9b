"""One page in a real browser, seen from outside: what it shows and what went wrong in it."""

import asyncio
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Final

from playwright.async_api import BrowserContext, ConsoleMessage, Page, Request

from tests.patience import PATIENCE_S

View = dict[str, Any]
"""Everything that a page knows, as `window.esplanade` tells it."""

NORTHWARD: Final = "#look=90"
_POLL_S: Final = 0.1

# The page's security policy forbids evaluating strings, so conditions are polled from here.
_COLLECT_VIOLATIONS: Final = """
window.violations = [];
document.addEventListener("securitypolicyviolation", (event) => {
  window.violations.push(`${event.violatedDirective}: ${event.blockedURI}`);
});
"""
_LOOK: Final = """() => {
  const { phase, id, avatars, doors, plan, chosenId, frames } = window.esplanade;
  return { phase, id, avatars, doors, plan, chosenId, frames };
}"""


@dataclass
class Visitor:
    """A page of the client and everything it complained about."""

    page: Page
    faults: list[str] = field(default_factory=list)

    @classmethod
    async def arrive(cls, context: BrowserContext, url: str, drawing: str = "fast") -> "Visitor":
        """Open the client in a new page, that draws as finely as is said.

        The first view goes to the north, unless the address says something of its own.
        """
        context.set_default_timeout(1e3 * PATIENCE_S)
        page = await context.new_page()
        visitor = cls(page)
        page.on("console", visitor._heard)
        page.on("pageerror", lambda error: visitor.faults.append(f"exception: {error}"))

        def requested(request: Request) -> None:
            if not request.url.startswith((url.split("#", maxsplit=1)[0], "data:", "blob:")):
                visitor.faults.append(f"asks elsewhere: {request.url}")

        page.on("request", requested)
        await page.add_init_script(_COLLECT_VIOLATIONS)
        await page.add_init_script(f"localStorage.setItem('esplanade.drawing', '{drawing}');")
        await page.goto(url if "#" in url else url + NORTHWARD)
        return visitor

    async def join(self, name: str) -> None:
        """Give a name at the door and wait until the world is there."""
        await self.page.fill("#join-name", name)
        await self.page.click("#join-button")
        await self.until(lambda view: view["phase"] == "live" and own(view) is not None)

    async def look(self) -> View:
        """Everything that the page knows now."""
        view: View = await self.page.evaluate(_LOOK)
        return view

    async def until(
        self, condition: Callable[[View], bool], patience_s: float = PATIENCE_S
    ) -> View:
        """Wait for what the page knows to fulfil a condition; returns that view.

        Raises
        ------
        AssertionError
            It did not within that time.
        """
        deadline_s = time.monotonic() + patience_s
        while True:
            view = await self.look()
            if condition(view):
                return view
            assert time.monotonic() < deadline_s, f"never came to be; last seen: {view}"
            await asyncio.sleep(_POLL_S)

    async def complaints(self) -> list[str]:
        """Console errors, exceptions, requests to elsewhere and broken security policies."""
        violations: list[str] = await self.page.evaluate("() => window.violations")
        return [*self.faults, *violations]

    def _heard(self, message: ConsoleMessage) -> None:
        if message.type in ("error", "warning"):
            self.faults.append(f"console {message.type}: {message.text}")


def own(view: View) -> dict[str, Any] | None:
    """The avatar of the page itself."""
    return next((avatar for avatar in view["avatars"] if avatar["own"]), None)


def avatar_of(view: View, avatar_id: int) -> dict[str, Any] | None:
    """Somebody in view."""
    return next((avatar for avatar in view["avatars"] if avatar["id"] == avatar_id), None)


def place_of(avatar: dict[str, Any]) -> tuple[float, float]:
    """The place where an avatar is drawn: x, y in metres."""
    return avatar["pose"]["x"], avatar["pose"]["y"]


def moved_m(view: View, before: dict[str, Any]) -> float:
    """The distance of an avatar from its place before; 0 while it is out of view."""
    now = avatar_of(view, before["id"])
    return math.dist(place_of(now), place_of(before)) if now else 0.0
