/** Bans: who is let in no more, until when, and by whom that was said. */

import { css, html, nothing, type TemplateResult } from "lit";
import { clock, typedMoment } from "../../models/times";
import { CommandingPanel } from "../commanding";

interface Ban {
  id: number;
  kinds: readonly string[];
  name_pattern: string | null;
  address: string | null;
  text: string;
  until_s: number | null;
  at_us: number;
  by: string | null;
  lifted: boolean;
  holds?: boolean;
}

class BansPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      tr.over td {
        color: var(--soft-ink);
      }
    `,
  ];
  private bans: readonly Ban[] = [];

  protected override begin(): void {
    this.hearAbout(/ban|revert|people/, () => void this.load());
    void this.load();
  }

  protected override render(): TemplateResult {
    const why = this.whyNot("ban");
    return html`
      ${this.refused()}
      <div class="scroll" tabindex="0" role="region" aria-label="Who is banned">
        <table>
          <thead>
            <tr>
              ${["Who", "Until", "Told", "By", "State"].map((name) => html`<th scope="col">${name}</th>`)}
            </tr>
          </thead>
          <tbody>
            ${this.bans.map((ban) => this.row(ban))}
          </tbody>
        </table>
      </div>
      ${this.bans.length === 0 ? html`<p class="soft">Nobody is banned.</p>` : nothing}
      <form
        @submit=${(event: SubmitEvent) => {
          event.preventDefault();
          void this.ban(event.currentTarget as HTMLFormElement);
        }}
      >
        <fieldset>
          <legend>Ban by name or address</legend>
          <div class="row">
            <label class="field grow"
              >Name (* for any characters) <input name="name" maxlength="64"
            /></label>
            <label class="field grow"
              >Address or range <input name="address" maxlength="64" placeholder="192.0.2.0/24"
            /></label>
            <label class="field"
              >Until (empty: for ever) <input name="until" type="datetime-local"
            /></label>
            <label class="field grow"
              >What they are told <input name="text" maxlength="200"
            /></label>
            <button type="submit" ?disabled=${why !== null} title=${why ?? ""}>Ban</button>
          </div>
        </fieldset>
      </form>
    `;
  }

  private row(ban: Ban): TemplateResult {
    const holds = ban.holds ?? !ban.lifted;
    const who = [ban.name_pattern, ban.address].filter(Boolean).join(", ");
    return html`<tr class=${holds ? "" : "over"}>
      <td>
        ${who || `#${ban.id}`} ${ban.kinds.map((kind) => html`<span class="chip">${kind}</span> `)}
      </td>
      <td>${ban.until_s === null ? "for ever" : clock(ban.until_s * 1e6)}</td>
      <td>${ban.text}</td>
      <td>${ban.by ?? ""}, ${clock(ban.at_us)}</td>
      <td>
        ${
          holds
            ? this.button("Lift", "unban", () => this.lift(ban.id), { label: `Lift ban ${ban.id}` })
            : ban.lifted
              ? "lifted"
              : "over"
        }
      </td>
    </tr>`;
  }

  private async ban(form: HTMLFormElement): Promise<void> {
    const given = new FormData(form);
    const text = (name: string): string => (given.get(name) as string).trim();
    const command: { op: string } & Record<string, unknown> = { op: "ban" };
    if (text("name") !== "") command["name_pattern"] = text("name");
    if (text("address") !== "") command["address"] = text("address");
    if (text("text") !== "") command["text"] = text("text");
    const until = typedMoment(text("until"));
    if (until !== null) command["until_s"] = until / 1e6;
    if (await this.carryOut(command, "The ban holds.")) form.reset();
    await this.load();
  }

  private async lift(ban: number): Promise<void> {
    await this.carryOut({ op: "unban", ban }, "The ban is lifted.");
    await this.load();
  }

  private async load(): Promise<void> {
    const found = await this.ask<{ bans: Ban[] }>("/bans");
    if (found) this.bans = found.bans;
    this.requestUpdate();
  }
}

customElements.define("esp-bans", BansPanel);
