/** Something that is shown once, to be copied. */

import { css, html, type TemplateResult } from "lit";
import type { AppContext } from "../../context";

export function secret(
  text: string,
  value: string,
  app: AppContext,
  shut: () => void,
): TemplateResult {
  const copy = async (): Promise<void> => {
    try {
      await navigator.clipboard.writeText(value);
      app.toast("It is copied.", "done");
    } catch {
      app.toast("This browser does not let the page copy; select it and copy it by hand.");
    }
  };
  return html`<div class="secret" role="status">
    <p>${text}</p>
    <code tabindex="0">${value}</code>
    <div class="row">
      <button class="main" @click=${() => void copy()}>Copy</button>
      <button @click=${shut}>I have it</button>
    </div>
  </div>`;
}

export const secretStyle = css`
  .secret {
    margin-bottom: 10px;
    padding: 8px;
    border: 2px solid var(--accent);
    border-radius: 8px;
    background: var(--accent-wash);
  }
  .secret code {
    display: block;
    margin-bottom: 8px;
    overflow-wrap: anywhere;
    user-select: all;
  }
`;
