"""The page in the languages that people read, and with names written from right to left."""

import re
from typing import Any, Final

import pytest
from playwright.async_api import Browser, BrowserContext, Locator, ViewportSize, expect

from tests.browser.visitor import Visitor, avatar_of
from tests.patience import PATIENCE_S

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

expect.set_options(timeout=1e3 * PATIENCE_S)

WORDS: Final[dict[str, dict[str, str]]] = {
    "de-DE": {
        "name": "Ada",
        "other": "Bea",
        "lang": "de",
        "button": "Eintreten",
        "no name": "Bitte gib einen Namen ein, den man sehen kann.",
        "live": "Verbunden",
        "greeting": "Willkommen, Ada. Unter „Hilfe“ steht, wie man sich bewegt.",
        "hint": "Etwas sagen …",
        "too long": "Das sind 4 Zeichen zu viel; höchstens 300 sind möglich.",
        "where": r"^\d+ m, (links|rechts|vor dir|hinter dir)",
        "nods": "Bea nickt.",
        "follows": "Du folgst Bea.",
        "people": r"^\d+ Personen und 6 Akteure in der Welt$",
        "help": "Wie man sich bewegt",
    },
    "zh-TW": {
        "name": "Cai",
        "other": "Dai",
        "lang": "zh-Hant-TW",
        "button": "進入",
        "no name": "請輸入一個看得見的名字。",
        "live": "已連線",
        "greeting": "歡迎，Cai。走動方式請見「說明」。",
        "hint": "說句話…",
        "too long": "多了 4 個字；最多 300 個字。",
        "where": r"^\d+ 公尺，[正左右]",
        "nods": "Dai 在點頭。",
        "follows": "你正在跟隨 Dai。",
        "people": r"^世界裡共有 \d+ 位真人與 6 個角色$",
        "help": "如何走動",
    },
}

SMALL: Final[ViewportSize] = {"width": 800, "height": 560}
"""A window whose picture is quickly drawn, and that has room for lists and chat."""

_EDGES: Final = """(holder, called) => {
  const name = [...holder.querySelectorAll("bdi")].find((bdi) => bdi.textContent === called);
  const after = document.createRange();
  after.selectNodeContents(name.nextSibling);
  return { name: name.getBoundingClientRect().right, after: after.getClientRects()[0].left };
}"""


async def met(
    profile: BrowserContext, other_profile: BrowserContext, url: str, *names: str
) -> tuple[Visitor, Visitor]:
    """Two people of these names, of whom the first sees the second."""
    one, other = await Visitor.arrive(profile, url), await Visitor.arrive(other_profile, url)
    await one.join(names[0])
    await other.join(names[1])
    other_id = (await other.look())["id"]
    await one.until(lambda view: avatar_of(view, other_id) is not None)
    return one, other


@pytest.mark.parametrize("locale", WORDS)
async def test_the_page_speaks_the_language_of_the_browser(
    browser: Browser, url: str, locale: str
) -> None:
    words = WORDS[locale]
    context = await browser.new_context(locale=locale, viewport=SMALL)
    other_context = await browser.new_context(viewport=SMALL)
    ann = await Visitor.arrive(context, url)
    page = ann.page
    await expect(page.locator("html")).to_have_attribute("lang", words["lang"])
    await expect(page.locator("#join-button")).to_have_text(words["button"])
    await page.fill("#join-name", " ")
    await page.click("#join-button")
    await expect(page.locator("#join-reason")).to_have_text(words["no name"])
    await ann.join(words["name"])
    await expect(page.locator("#status-text")).to_have_text(words["live"])
    await expect(page.locator("#chat-lines")).to_contain_text(words["greeting"])
    await expect(page.locator("#chat-line")).to_have_attribute("placeholder", words["hint"])
    await page.fill("#chat-line", "x" * 304)
    await expect(page.locator("#chat-fault")).to_have_text(words["too long"])
    await page.fill("#chat-line", "")

    ben = await Visitor.arrive(other_context, url)
    await ben.join(words["other"])
    await page.click("#people-open")
    await expect(page.locator("#people-total")).to_have_text(re.compile(words["people"]))
    await page.locator("#people-list li.person button", has_text=words["other"]).click()
    await expect(page.locator("#person-where")).to_have_text(re.compile(words["where"]))
    await page.click("#person-follow")
    await expect(page.locator("#following-whom")).to_have_text(words["follows"])
    await ben.page.keyboard.press("Digit2")
    await expect(page.locator("#captions")).to_have_text(words["nods"])
    await page.click("#help-open")
    await expect(page.locator("#help-title")).to_have_text(words["help"])
    assert await ann.complaints() == []


async def test_a_language_is_chosen_at_the_door_and_kept(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await expect(ann.page.locator("#join-button")).to_have_text("Come in")
    await ann.page.select_option("#join-language", "de")
    await expect(ann.page.locator("#join-button")).to_have_text("Eintreten")
    await expect(ann.page.get_by_label("Dein Name")).to_be_visible()
    await ann.page.reload()
    await expect(ann.page.locator("#join-button")).to_have_text("Eintreten")


async def test_a_language_is_changed_in_the_world_without_leaving_it(
    url: str, profile: BrowserContext
) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Eva")
    page, before = ann.page, await ann.look()
    await page.click("#people-open")
    await page.click("#plan-open")
    await page.click("#help-open")
    await page.select_option("#help-language", "zh-Hant")
    await expect(page.locator("#help-title")).to_have_text("如何走動")
    await page.click("#help-close")
    told: dict[str, str | re.Pattern[str]] = {
        "#status-text": "已連線",
        "#plan-title": "尚未選擇角色",
        "#people-list li.own small": "你",
        "#people-list summary >> nth=1": re.compile("^角色"),
        "#gestures-toggle": "動作",
        "#gestures button >> nth=0": "1 揮手",
        "#look-parts legend >> nth=0": "上衣",
    }
    for selector, text in told.items():
        await expect(page.locator(selector)).to_have_text(text)
    await expect(page.locator("#look-parts input").first).to_have_attribute("aria-label", "紅色")
    after = await ann.look()
    assert (after["phase"], after["id"]) == ("live", before["id"])


async def edges_at(name: str, holder: Locator) -> dict[str, Any]:
    """The right edge of a name in a sentence, and the left edge of what follows it."""
    edges: dict[str, Any] = await holder.evaluate(_EDGES, name)
    return edges


async def test_an_arabic_name_turns_no_sentence_over(
    url: str, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    """The rest of a sentence stands to the right of a name in it, digits too."""
    name = "مريم"
    ann, other = await met(profile, other_profile, url, "Fay", name)
    page = ann.page
    await page.keyboard.press("l")
    around = page.locator("#chat-lines .note", has_text=name)
    await expect(around).to_contain_text(re.compile(rf"{name}, \d+ m, "))
    await page.click("#people-open")
    await page.locator("#people-list li.person button", has_text=name).click()
    await expect(page.locator("#person-name bdi")).to_have_text(name)
    await page.click("#person-follow")
    follows = page.locator("#following-whom")
    await expect(follows).to_have_text(f"You follow {name}.")
    for holder in (around, follows):
        edges = await edges_at(name, holder)
        assert edges["after"] >= edges["name"] - 1.0
    await other.page.keyboard.press("Enter")
    await other.page.fill("#chat-line", "مرحبا!")
    await other.page.keyboard.press("Enter")
    said = page.locator("#chat-lines li:not(.note)", has_text="مرحبا!")
    directions = "(line) => [...line.children].map((part) => getComputedStyle(part).direction)"
    await said.wait_for()
    assert await said.evaluate(directions) == ["rtl", "rtl"]
    assert await said.evaluate("(line) => getComputedStyle(line).direction") == "ltr"
