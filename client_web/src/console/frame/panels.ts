/** The elements of the panels: each is made when it is first shown, and kept with what is in it. */

import type { AppContext } from "../context";
import { panelOf } from "../panels/registry";

export class Panels {
  private readonly made = new Map<string, HTMLElement>();
  private readonly loading = new Set<string>();

  constructor(
    private readonly app: AppContext,
    /** Called when a panel that was asked for has come. */
    private readonly ready: () => void,
  ) {}

  /** The element of a panel; null until its code is there. */
  element(id: string): HTMLElement | null {
    const made = this.made.get(id);
    if (made) return made;
    const entry = panelOf(id);
    if (!entry || this.loading.has(id)) return null;
    if (customElements.get(entry.tag)) {
      const element = Object.assign(document.createElement(entry.tag), { app: this.app });
      this.made.set(id, element);
      return element;
    }
    this.loading.add(id);
    entry
      .load()
      .catch(() => {
        this.app.toast(`the panel ${entry.title} could not be loaded`, "fault");
      })
      .finally(() => {
        this.loading.delete(id);
        if (customElements.get(entry.tag)) this.ready();
      });
    return null;
  }

  /** Forget all of them, with what is in them: somebody else may come. */
  drop(): void {
    this.made.clear();
  }
}
