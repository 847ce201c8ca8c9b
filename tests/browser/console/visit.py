"""An operators' page in a real browser: what it shows, and what the browser complained of."""

from pathlib import Path
from typing import Any, Final

from playwright.async_api import Browser, Locator, Page

from esplanade.server.app import Running
from tests.browser.console.stage_answers import ACCOUNT, PASSWORD
from tests.patience import PATIENCE_S

AXE: Final = Path(__file__).parents[3] / "client_web/node_modules/axe-core/axe.min.js"
_REFUSAL: Final = "Failed to load resource"
"""The browser says so of every refusal, which the page shows by itself."""


class Visit:
    """A page of an operator."""

    def __init__(self, page: Page, url: str, account: str = ACCOUNT) -> None:
        self.page, self.url, self.account = page, url, account
        self.complaints: list[str] = []
        page.set_default_timeout(1e3 * PATIENCE_S)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("console", self._heard)

    def _heard(self, message: Any) -> None:
        if message.type in ("error", "warning") and not message.text.startswith(_REFUSAL):
            self.complaints.append(message.text)

    async def open(self, fragment: str = "") -> None:
        """Load the page anew."""
        await self.page.goto("about:blank")
        await self.page.goto(self.url + fragment)

    async def log_in(self, password: str = PASSWORD) -> None:
        """Fill in the form and send it."""
        await self.page.fill("#name", self.account)
        await self.page.fill("#password", password)
        await self.page.press("#password", "Enter")

    async def come_in(self, fragment: str = "") -> None:
        """Load the page, log in, and wait until everybody is on the map."""
        await self.open(fragment)
        await self.log_in()
        await self.page.wait_for_selector("text=live")
        await self.page.wait_for_selector("canvas.map[data-ms]")

    async def log_out(self) -> None:
        """Log out, and wait for the form."""
        await self.page.locator("esp-topbar summary", has_text=self.account).click()
        await self.page.get_by_role("button", name="Log out").click()
        await self.page.wait_for_selector("#password")

    async def show(self, title: str) -> None:
        """Bring a panel to the front, by the list of panels if it has no tab."""
        tab = self.page.get_by_role("tab", name=title, exact=True)
        if await tab.count() == 0:
            await self.page.locator("esp-topbar summary", has_text="Panels").click()
            await self.page.locator("esp-topbar details button", has_text=title).first.click()
        else:
            await tab.click()

    def panel(self, name: str) -> Locator:
        """The element of a panel."""
        return self.page.locator(f"esp-{name}")

    def row(self, field_name: str) -> Locator:
        """The row of a parameter."""
        return self.page.locator(f'esp-parameters [data-field="{field_name}"]')

    def box(self, field_name: str) -> Locator:
        """The number of a parameter."""
        return self.row(field_name).get_by_role("textbox")

    def slider(self, field_name: str) -> Locator:
        """The slider of a parameter."""
        return self.row(field_name).get_by_role("slider")

    async def draw(self, *parts: tuple[float, float]) -> None:
        """Click places on the map, as parts of its width and height, and say that this is all."""
        canvas = self.page.locator("canvas.map")
        box = await canvas.bounding_box()
        assert box is not None
        for across, down in parts:
            x, y = across * box["width"], down * box["height"]
            await canvas.click(position={"x": x, "y": y})
        await self.page.get_by_role("button", name="Done", exact=True).click()

    async def findings(self) -> list[str]:
        """The findings of axe in the page as it is now."""
        await self.page.evaluate(AXE.read_text())
        found = await self.page.evaluate("axe.run(document, {resultTypes: ['violations']})")
        return [
            f"{each['id']}: {node['html'][:160]} {node['failureSummary']}"
            for each in found["violations"]
            for node in each["nodes"]
        ]

    async def overflow_px(self) -> int:
        """The width by which the page exceeds its window."""
        return int(await self.page.evaluate("document.documentElement.scrollWidth - innerWidth"))


async def visit_of(
    browser: Browser,
    url: str,
    width: int = 1280,
    height: int = 900,
    scheme: Any = "light",
    account: str = ACCOUNT,
) -> Visit:
    """A page in a window of a size, in a colour scheme; it is not loaded yet."""
    context = await browser.new_context(
        viewport={"width": width, "height": height}, color_scheme=scheme
    )
    return Visit(await context.new_page(), url, account)


async def arrived(
    browser: Browser, server: Running, account: str, fragment: str = "", **look: Any
) -> Visit:
    """An operator who has logged in at a server, perhaps by a link to something."""
    url = f"http://127.0.0.1:{server.private_port}/console/"
    visit = await visit_of(browser, url, account=account, **look)
    await visit.come_in(fragment)
    return visit
