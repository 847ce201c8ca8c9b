/** Keys of what one does beside walking: digits are gestures, G opens their menu, L tells who is near. */

import { isTyping } from "./keyboard";

const MENU = "KeyG";
const TELL = "KeyL";
const DIGIT = /^(?:Digit|Numpad)([1-9])$/;

/** `make` is called with the digit. */
export function listenToGestureKeys(
  page: Window,
  make: (digit: number) => void,
  openMenu: () => void,
  tell: () => void,
): void {
  page.addEventListener("keydown", (event) => {
    if (event.repeat || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.defaultPrevented || isTyping(event.target)) return;
    if (document.querySelector("dialog[open]")) return;
    const digit = DIGIT.exec(event.code)?.[1];
    if (digit !== undefined) make(Number(digit));
    else if (event.code === MENU) openMenu();
    else if (event.code === TELL) tell();
  });
}
