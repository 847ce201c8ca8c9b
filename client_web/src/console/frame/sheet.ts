/** The sheet of all keys. */

import { css, html, LitElement, type TemplateResult } from "lit";
import type { Shortcuts } from "../state/shortcuts";
import { controls } from "../style/controls";

const LETTERS_KEY = "esplanade-console-letters";
const ELSEWHERE: readonly (readonly [string, string])[] = [
  ["Tab, Shift Tab", "to the next control, and back"],
  [
    "Arrows",
    "between tabs and rows; on a bar between two areas: move it; on the map: move the map",
  ],
  ["+ − 0", "on the map: nearer, farther, all of it"],
  ["Enter", "on the map: choose the one nearest to the middle"],
  ["Ctrl A", "on the map: choose all that are shown"],
  ["Delete", "on a tab: close it"],
  ["Escape", "close what is open; else choose nobody"],
];

export class Sheet extends LitElement {
  static override styles = [
    controls,
    css`
      dialog {
        max-width: min(620px, calc(100vw - 32px));
        max-height: calc(100dvh - 32px);
        padding: 18px 22px;
        border: 1px solid var(--line);
        border-radius: 12px;
        background: var(--paper);
        color: var(--ink);
      }

      dialog::backdrop {
        background: rgb(0 0 0 / 45%);
      }

      th {
        white-space: nowrap;
      }
    `,
  ];
  static override properties = { shortcuts: { attribute: false } };
  declare shortcuts: Shortcuts;

  override firstUpdated(): void {
    this.shortcuts.lettersOn = localStorage.getItem(LETTERS_KEY) !== "off";
    this.requestUpdate();
  }

  open(): void {
    this.requestUpdate();
    this.renderRoot.querySelector("dialog")?.showModal();
  }

  protected override render(): TemplateResult {
    return html`<dialog aria-labelledby="title">
      <h2 id="title">Keys</h2>
      <table>
        ${[...this.shortcuts.list().map(({ key, text }) => [key, text] as const), ...ELSEWHERE].map(
          ([key, text]) =>
            html`<tr>
              <th scope="row"><kbd>${key}</kbd></th>
              <td>${text}</td>
            </tr>`,
        )}
      </table>
      <p>
        <label
          ><input
            type="checkbox"
            .checked=${this.shortcuts.lettersOn}
            @change=${(event: Event) => {
              this.setLetters((event.target as HTMLInputElement).checked);
            }}
          />
          Keys of one letter work everywhere</label
        >
      </p>
      <form method="dialog"><button class="main">Close</button></form>
    </dialog>`;
  }

  private setLetters(on: boolean): void {
    this.shortcuts.lettersOn = on;
    localStorage.setItem(LETTERS_KEY, on ? "on" : "off");
  }
}

customElements.define("esp-sheet", Sheet);
