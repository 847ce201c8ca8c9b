/** The state of the page in its address: a link shows the same to whoever may log in. */

import type { AppContext } from "../context";
import { areaOf, type Layout, writeLayout } from "../layout/layout";
import { type Shared, writeFragment } from "../state/fragment";

const WRITE_MS = 300;

interface Page {
  layout: () => Layout;
  /** The panel that was shown last. */
  front: () => string;
  isIn: () => boolean;
}

export class Address {
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly app: AppContext,
    private readonly page: Page,
  ) {}

  /** Soon, the address shows the same after it is loaded anew. */
  write(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      if (!this.page.isIn()) return;
      const text = writeFragment(this.shared());
      history.replaceState(null, "", location.pathname + location.search + (text && `#${text}`));
    }, WRITE_MS);
  }

  /** Copy a link to the page as it is, with its layout. */
  async copyLink(): Promise<void> {
    const text = writeFragment({ ...this.shared(), layout: writeLayout(this.page.layout()) });
    const link = `${location.origin}${location.pathname}#${text}`;
    try {
      await navigator.clipboard.writeText(link);
      this.app.toast("The link is copied. It shows the same to whoever may log in.", "done");
    } catch {
      // Without a clipboard the link stands in the address.
      history.replaceState(null, "", link);
      this.app.toast("The link stands in the address of this page now.");
    }
  }

  private shared(): Shared {
    const { chosen, draft, moment } = this.app.state;
    const front = this.page.front();
    return {
      chosen: chosen.value,
      panel: areaOf(this.page.layout(), front) ? front : null,
      draft: draft.value,
      moment: moment.value,
      layout: null,
    };
  }
}

/** Show what a link says, but for its panel and layout. */
export function takeShared(app: AppContext, shared: Shared): void {
  if (shared.chosen.length > 0) app.choose(shared.chosen);
  if (shared.draft) app.state.draft.value = shared.draft;
  if (shared.moment !== null) app.state.moment.value = shared.moment;
}
