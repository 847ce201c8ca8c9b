/** Fields of one line that several panels have. */

import { html, type TemplateResult } from "lit";

/** A field that says which rows of a panel are shown. */
export function searchField(
  label: string,
  value: string,
  take: (text: string) => void,
  hint = "",
): TemplateResult {
  return html`<label class="field grow">
    ${label}
    <input
      type="search"
      placeholder=${hint}
      .value=${value}
      @input=${(event: Event) => {
        take((event.currentTarget as HTMLInputElement).value);
      }}
    />
  </label>`;
}

/** A field for the note that goes with a command into the audit. */
export function noteField(value: string, take: (text: string) => void): TemplateResult {
  return html`<label class="grow">
    <span class="visually-hidden">Why (kept in the audit)</span>
    <input
      maxlength="500"
      placeholder="Why? (kept in the audit)"
      .value=${value}
      @input=${(event: Event) => {
        take((event.currentTarget as HTMLInputElement).value);
      }}
    />
  </label>`;
}
