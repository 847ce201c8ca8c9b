"""An operators' page in a real browser: what it shows, and what went wrong in it."""

from dataclasses import dataclass, field
from typing import Final

from playwright.async_api import BrowserContext, ConsoleMessage, Locator, Page

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.app import Running
from tests.patience import PATIENCE_S

PASSWORD: Final = "long enough for tests"
_COLLECT_VIOLATIONS: Final = """
window.violations = [];
document.addEventListener("securitypolicyviolation", (event) => {
  window.violations.push(`${event.violatedDirective}: ${event.blockedURI}`);
});
"""
_EXPECTED: Final = "Failed to load resource"
"""The browser says so of every refusal; what the page makes of it is what counts."""


@dataclass
class OperatorPage:
    """A page of the console, and everything that it complained about."""

    page: Page
    name: str
    faults: list[str] = field(default_factory=list)

    @classmethod
    async def arrive(cls, context: BrowserContext, server: Running, name: str) -> "OperatorPage":
        """Open the page and log in."""
        context.set_default_timeout(1e3 * PATIENCE_S)
        page = await context.new_page()
        found = cls(page, name)
        page.on("console", found._heard)
        page.on("pageerror", lambda error: found.faults.append(f"exception: {error}"))
        await page.add_init_script(_COLLECT_VIOLATIONS)
        await page.goto(f"http://127.0.0.1:{server.private_port}/console")
        await found.log_in()
        return found

    async def log_in(self) -> None:
        """Give name and password, with the keyboard alone."""
        await self.page.get_by_label("Name", exact=True).wait_for()
        await self.page.get_by_label("Name", exact=True).fill(self.name)
        await self.page.get_by_label("Password", exact=True).fill(PASSWORD)
        await self.page.keyboard.press("Enter")
        await self.page.get_by_role("tab").first.wait_for()

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

    async def check_nothing_went_wrong(self) -> None:
        """No exception, no complaint, nothing against the security policy."""
        violations = await self.page.evaluate("window.violations")
        assert not self.faults
        assert not violations

    def _heard(self, message: ConsoleMessage) -> None:
        if message.type == "error" and _EXPECTED not in message.text:
            self.faults.append(message.text)


async def operator(server: Running, name: str, role: str) -> None:
    """A new account with a password."""
    await server.kept.directory.add(MACHINE, name, role, PASSWORD)
