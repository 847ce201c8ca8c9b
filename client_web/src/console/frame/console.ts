/** The whole page: who is logged in, and the panels around the map. */

import { html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import type { AppContext, Mood } from "../context";
import { LayoutStore } from "../layout/keeping";
import {
  AREAS,
  type Layout,
  moved,
  readLayout,
  resized,
  shown,
  shut,
  usualLayout,
} from "../layout/layout";
import { panelOf } from "../panels/registry";
import { firstToken, readFragment, type Shared } from "../state/fragment";
import { Session } from "../state/session";
import { type Stop, Watching } from "../state/signal";
import { takesText } from "../state/shortcuts";
import { controls } from "../style/controls";
import { Address, takeShared } from "./address";
import type { AreaWish } from "./area";
import { allowed, alone, type Areas, wide } from "./areas";
import { frame } from "./framestyle";
import "./login";
import { Panels } from "./panels";
import { pageKeys } from "./pagekeys";
import type { Sheet } from "./sheet";
import "./sheet";
import { makeContext } from "./starting";
import type { Toasts } from "./toasts";
import "./toasts";
import "./topbar";
import { watchWorld } from "./worldwatch";

/** Below this width there are tabs instead of columns. */
const NARROW = "(max-width: 899px)";

export class Console extends LitElement {
  static override styles = [controls, frame];

  readonly app: AppContext;
  private readonly session: Session;
  private readonly panels: Panels;
  private readonly store = new LayoutStore(localStorage);
  private readonly narrow = matchMedia(NARROW);
  private layout: Layout = usualLayout();
  /** The panel that was shown last, which a narrow page shows alone. */
  private front: string;
  private shared: Shared | null;
  private stopWatching: Stop | null = null;
  private readonly address: Address;

  constructor() {
    super();
    const token = firstToken(location.hash);
    this.shared = readFragment(location.hash);
    // The token is for this page alone: it goes from the address before anything else happens.
    if (token !== null) history.replaceState(null, "", location.pathname + location.search);
    this.app = makeContext(new URL(location.href), {
      toast: (text: string, mood: Mood = "note") => {
        this.renderRoot.querySelector<Toasts>("esp-toasts")?.add(text, mood);
      },
      show: (panel) => {
        this.show(panel);
      },
    });
    this.panels = new Panels(this.app, () => {
      this.requestUpdate();
    });
    this.front = "map";
    this.session = new Session(this.app.api, this.app.state, token);
    this.address = new Address(this.app, {
      layout: () => this.layout,
      front: () => this.front,
      isIn: () => this.session.standing.value === "in",
    });
    this.app.live.mayConnect = () => this.session.holds();
    this.app.live.refused = (faults) => {
      this.app.toast(faults.map(({ text }) => text).join("; "), "fault");
    };
    const { state } = this.app;
    new Watching(this, () => [this.session.standing, state.me, state.picking]);
    this.session.standing.watch((standing) => {
      if (standing === "in") this.enter();
      else if (standing === "out") this.leave();
    });
    for (const signal of [state.chosen, state.draft, state.moment]) {
      signal.watch(() => {
        this.address.write();
      });
    }
    this.narrow.addEventListener("change", () => {
      this.requestUpdate();
    });
    addEventListener("hashchange", () => {
      this.shared = readFragment(location.hash);
      if (this.session.standing.value === "in") this.useShared();
    });
    addEventListener("keydown", (event) => {
      this.key(event);
    });
    pageKeys(this.app, {
      focusArea: (step) => {
        this.focusArea(step);
      },
      sheet: () => {
        this.renderRoot.querySelector<Sheet>("esp-sheet")?.open();
      },
      copyLink: () => {
        void this.address.copyLink();
      },
    });
    void this.session.begin();
  }

  protected override render(): TemplateResult {
    const standing = this.session.standing.value;
    const isIn = standing === "in" || standing === "away";
    return html`
      ${isIn ? this.page(standing === "away") : nothing}
      ${
        standing === "in"
          ? nothing
          : html`<esp-login
              .session=${this.session}
              .account=${this.app.state.me.value?.account ?? ""}
              .over=${standing === "away"}
              data-standing=${standing}
            ></esp-login>`
      }
      <esp-sheet .shortcuts=${this.app.shortcuts}></esp-sheet>
      <esp-toasts></esp-toasts>
    `;
  }

  protected override updated(changes: PropertyValues): void {
    super.updated(changes);
    const { left, right, bottom } = this.layout.areas;
    this.style.setProperty("--left", `${left.size}px`);
    this.style.setProperty("--right", `${right.size}px`);
    this.style.setProperty("--bottom", `${bottom.size}px`);
    this.renderRoot.querySelector<LitElement>("esp-login")?.requestUpdate();
  }

  private page(isAway: boolean): TemplateResult {
    const open = new Set(AREAS.flatMap((area) => this.areas.visible(area).panels));
    return html`
      <div class="page" ?inert=${isAway}>
        <header>
          <esp-topbar
            .app=${this.app}
            .layout=${this.layout}
            .shown=${open}
            @layout=${(event: CustomEvent<Layout>) => {
              this.setLayout(event.detail);
            }}
            @copylink=${() => void this.address.copyLink()}
            @keys=${() => this.renderRoot.querySelector<Sheet>("esp-sheet")?.open()}
            @logout=${() => void this.logOut()}
          ></esp-topbar>
        </header>
        <main class=${this.narrow.matches ? "narrow" : "wide"}>
          ${this.narrow.matches ? alone(this.areas, this.front) : wide(this.areas)}
        </main>
      </div>
    `;
  }

  private readonly areas: Areas = {
    visible: (name) => allowed(this.layout.areas[name], (right) => this.app.state.may(right)),
    content: (panel) => this.panels.element(panel),
    wish: (event) => {
      this.wish(event);
    },
    resize: (name, size) => {
      this.setLayout(resized(this.layout, name, size));
    },
  };

  private readonly wish = (event: CustomEvent<AreaWish>): void => {
    const wish = event.detail;
    if (wish.wish === "move") this.setLayout(moved(this.layout, wish.panel, wish.to));
    else if (wish.wish === "shut") this.setLayout(shut(this.layout, wish.panel));
    else this.show(wish.panel);
  };

  private show(panel: string): void {
    const entry = panelOf(panel);
    if (!entry) return;
    this.front = panel;
    this.setLayout(shown(this.layout, entry));
    this.address.write();
  }

  private setLayout(layout: Layout): void {
    this.layout = layout;
    const account = this.app.state.me.value?.account;
    if (account !== undefined) this.store.write(account, layout);
    this.requestUpdate();
  }

  private enter(): void {
    if (this.stopWatching) return;
    this.layout = this.store.read(this.app.state.me.value?.account ?? "");
    this.useShared();
    this.stopWatching = watchWorld(this.app);
    this.app.live.start();
  }

  private leave(): void {
    this.stopWatching?.();
    this.stopWatching = null;
    this.app.live.stop();
    this.panels.drop();
    this.app.state.world.value = null;
    this.app.state.draft.value = null;
    history.replaceState(null, "", location.pathname + location.search);
  }

  private useShared(): void {
    const { shared } = this;
    this.shared = null;
    if (!shared) return;
    const layout = shared.layout === null ? null : readLayout(shared.layout);
    if (layout) this.layout = layout;
    takeShared(this.app, shared);
    if (shared.panel !== null) this.show(shared.panel);
    this.requestUpdate();
  }

  private async logOut(): Promise<void> {
    try {
      await this.session.logOut();
    } catch {
      this.app.toast("the server does not answer; you are still logged in", "fault");
    }
  }

  private key(event: KeyboardEvent): void {
    if (this.session.standing.value !== "in" || event.defaultPrevented) return;
    const path = event.composedPath();
    // A dialog has its own Escape.
    if (path.some((each) => each instanceof HTMLDialogElement)) return;
    const [target] = path;
    if (this.app.shortcuts.press(event, takesText(target))) event.preventDefault();
  }

  private focusArea(step: number): void {
    const areas = [...this.renderRoot.querySelectorAll<HTMLElement>("esp-area")];
    const at = areas.findIndex((area) => area === this.shadowRoot?.activeElement);
    areas[(at + step + areas.length) % areas.length]?.focus();
  }
}

customElements.define("esp-console", Console);
