import { html } from "lit";
import { Panel } from "../panels/panel";
class InspectorPanel extends Panel {
  protected override render(): unknown {
    return html`<p>…</p>`;
  }
}
customElements.define("esp-inspector", InspectorPanel);
