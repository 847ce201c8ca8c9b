/** Keys of the whole page, which are told in one sheet. */

import type { Stop } from "./signal";

export interface Shortcut {
  /** As in `KeyboardEvent.key`, after `Alt+` where that is held. */
  key: string;
  /** Its effect, for the sheet. */
  text: string;
  call: () => void;
}

export class Shortcuts {
  /** Single characters may be switched off, for those who talk to their machine. */
  lettersOn = true;
  private readonly all: Shortcut[] = [];

  add(...shortcuts: readonly Shortcut[]): Stop {
    this.all.push(...shortcuts);
    return () => {
      for (const shortcut of shortcuts) this.all.splice(this.all.indexOf(shortcut), 1);
    };
  }

  list(): readonly Shortcut[] {
    return this.all;
  }

  /** Carry out what a key stands for; false where it stands for nothing. */
  press(
    event: Pick<KeyboardEvent, "key" | "altKey" | "ctrlKey" | "metaKey">,
    typing: boolean,
  ): boolean {
    if (event.ctrlKey || event.metaKey) return false;
    const key = event.altKey ? `Alt+${event.key}` : event.key;
    if (key.length === 1 && (typing || !this.lettersOn)) return false;
    const found = this.all.findLast((shortcut) => shortcut.key === key);
    found?.call();
    return found !== undefined;
  }
}

/** Whether the keys that an element gets are meant as text or values. */
export function takesText(target: EventTarget | undefined): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || target instanceof HTMLTextAreaElement) return true;
  if (target instanceof HTMLSelectElement) return true;
  const silent = ["button", "checkbox", "radio", "range", "submit"];
  return target instanceof HTMLInputElement && !silent.includes(target.type);
}
