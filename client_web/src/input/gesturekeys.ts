/** Keys of gestures: the digits make one each, and G opens their menu. */

import { isTyping } from "./keyboard";

const MENU = "KeyG";
const DIGIT = /^(?:Digit|Numpad)([1-9])$/;

/** `make` is called with the digit. */
export function listenToGestureKeys(
  page: Window,
  make: (digit: number) => void,
  openMenu: () => void,
): void {
  page.addEventListener("keydown", (event) => {
    if (event.repeat || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.defaultPrevented || isTyping(event.target)) return;
    if (document.querySelector("dialog[open]")) return;
    const digit = DIGIT.exec(event.code)?.[1];
    if (digit !== undefined) make(Number(digit));
    else if (event.code === MENU) openMenu();
  });
}
