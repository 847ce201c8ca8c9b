/** Keeps each account's layout in this browser. */

import { type Layout, readLayout, usualLayout, writeLayout } from "./layout";

const KEY = "esplanade-console-layout:";

export class LayoutStore {
  constructor(private readonly storage: Pick<Storage, "getItem" | "setItem"> | null) {}

  read(account: string): Layout {
    let text: string | null = null;
    try {
      text = this.storage?.getItem(KEY + account) ?? null;
    } catch {
      // A browser may forbid this; then everybody begins with the usual one.
    }
    return (text === null ? null : readLayout(text)) ?? usualLayout();
  }

  write(account: string, layout: Layout): void {
    try {
      this.storage?.setItem(KEY + account, writeLayout(layout));
    } catch {
      // It is full or forbidden; the layout holds until the page is closed.
    }
  }
}
