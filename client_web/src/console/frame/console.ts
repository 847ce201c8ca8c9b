/** The whole page: who is logged in, and the panels around the map. */

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { html as staticHtml, unsafeStatic } from "lit/static-html.js";
import type { AppContext } from "../context";
import { addressesOf } from "../net/addresses";
import { Api } from "../net/api";
import { Live } from "../net/live";
import { PANELS } from "../panels/registry";
import { State } from "../state/state";
import { controls } from "../style/controls";

export class Console extends LitElement {
  static override styles = [
    controls,
    css`
      :host {
        display: block;
        padding: 8px;
      }
    `,
  ];

  readonly app: AppContext;

  constructor() {
    super();
    const addresses = addressesOf(new URL(location.href));
    const state = new State();
    this.app = {
      api: new Api(addresses.api),
      live: new Live(addresses.live),
      state,
      choose: (ids) => {
        state.chosen.value = ids === null ? [] : typeof ids === "string" ? [ids] : ids;
      },
      toast: (text) => {
        console.info(text);
      },
      show: () => undefined,
    };
    void Promise.all(PANELS.map((panel) => panel.load()));
    this.app.live.start();
  }

  protected override render(): TemplateResult | typeof nothing {
    return html`<main>
      ${PANELS.map((panel) => {
        const tag = unsafeStatic(panel.tag);
        return staticHtml`<section><h2>${panel.title}</h2><${tag} .app=${this.app}></${tag}></section>`;
      })}
    </main>`;
  }
}

customElements.define("esp-console", Console);
