/** Ways into a closed world: invitation links for people, and tokens of bots. */

import { css, html, nothing, type TemplateResult } from "lit";
import { clock, day } from "../../models/times";
import { CommandingPanel } from "../commanding";
import { secret, secretStyle } from "./secret";

interface Invitation {
  id: string;
  label: string | null;
  by: string | null;
  uses: number;
  used: number;
  expires_us: number;
  revoked: boolean;
}

interface Bot {
  name: string;
  by: string | null;
  message_rate: number;
  connections: number;
  expires_us: number;
}

interface Made {
  url?: string;
  token?: string;
}

class InvitationsPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    secretStyle,
    css`
      li.row {
        padding: 4px 0;
        border-bottom: 1px solid var(--line);
      }
    `,
  ];
  private invitations: readonly Invitation[] = [];
  private bots: readonly Bot[] = [];
  private made: string | null = null;

  protected override begin(): void {
    this.hearAbout(/invitation|bot/, () => void this.load());
    void this.load();
  }

  protected override render(): TemplateResult {
    return html`
      ${this.refused()}
      ${
        this.made === null
          ? nothing
          : secret("It is shown this once.", this.made, this.app, () => {
              this.made = null;
              this.requestUpdate();
            })
      }
      <fieldset>
        <legend>Invitations of people</legend>
        <ul class="plain">
          ${this.invitations.map((one) => {
            const over = one.revoked || one.used >= one.uses || one.expires_us < Date.now() * 1000;
            return html`<li class="row">
              <span class="grow">
                <b>${one.label ?? one.id}</b>
                <span class="soft">
                  used ${one.used} of ${one.uses} times, until ${clock(one.expires_us)},
                  ${one.by ?? ""}
                </span>
              </span>
              ${
                over
                  ? html`<span class="chip">${one.revoked ? "taken back" : "over"}</span>`
                  : html`<button
                      aria-label="Take back invitation ${one.label ?? one.id}"
                      @click=${() => void this.drop(`/invitations/${one.id}`)}
                    >
                      Take back
                    </button>`
              }
            </li>`;
          })}
        </ul>
        <form
          class="row"
          @submit=${(event: SubmitEvent) => {
            event.preventDefault();
            void this.invite(event.currentTarget as HTMLFormElement);
          }}
        >
          <label class="field grow">For whom, or why <input name="label" maxlength="200" /></label>
          <label class="field"
            >Hours
            <input name="hours" class="short number" type="number" min="1" max="8760" value="24"
          /></label>
          <label class="field"
            >Uses
            <input name="uses" class="short number" type="number" min="1" max="1000" value="1"
          /></label>
          <button type="submit">Invite</button>
        </form>
      </fieldset>
      <fieldset>
        <legend>Bots</legend>
        <ul class="plain">
          ${this.bots.map(
            (one) =>
              html`<li class="row">
                <span class="grow">
                  <b>${one.name}</b>
                  <span class="soft"
                    >${one.message_rate} messages a second, ${one.connections} at once, until
                    ${day(one.expires_us)}</span
                  >
                </span>
                <button
                  aria-label="Revoke the bot ${one.name}"
                  @click=${() => void this.drop(`/bots/${encodeURIComponent(one.name)}`)}
                >
                  Revoke
                </button>
              </li>`,
          )}
        </ul>
        <form
          class="row"
          @submit=${(event: SubmitEvent) => {
            event.preventDefault();
            void this.bot(event.currentTarget as HTMLFormElement);
          }}
        >
          <label class="field grow">Name <input name="name" required maxlength="32" /></label>
          <button type="submit">Let a bot in</button>
        </form>
      </fieldset>
    `;
  }

  private async invite(form: HTMLFormElement): Promise<void> {
    const given = new FormData(form);
    const body = {
      label: given.get("label") === "" ? null : given.get("label"),
      expires_hours: Number(given.get("hours")),
      uses: Number(given.get("uses")),
    };
    await this.make("/invitations", body, form);
  }

  private async bot(form: HTMLFormElement): Promise<void> {
    await this.make("/bots", { name: new FormData(form).get("name") }, form);
  }

  private async make(path: string, body: object, form: HTMLFormElement): Promise<void> {
    const made = await this.attempt(this.app.api.send<Made>("POST", path, body));
    if (!made) return;
    this.made = made.url ?? made.token ?? null;
    form.reset();
    await this.load();
  }

  private async drop(path: string): Promise<void> {
    await this.attempt(this.app.api.send("DELETE", path));
    await this.load();
  }

  private async load(): Promise<void> {
    const found = await this.ask<{ invitations: Invitation[] }>("/invitations");
    if (found) this.invitations = found.invitations;
    if (this.whyNot("accounts") === null) {
      const bots = await this.ask<{ bots: Bot[] }>("/bots");
      if (bots) this.bots = bots.bots;
    }
    this.requestUpdate();
  }
}

customElements.define("esp-invitations", InvitationsPanel);
