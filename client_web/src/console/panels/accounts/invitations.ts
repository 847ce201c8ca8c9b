/** Ways into a closed world: invitation links for people, and tokens of bots. */

import { css, html, nothing, type TemplateResult } from "lit";
import { clock, day } from "../../models/times";
import { CommandingPanel } from "../commanding";
import { secret, secretStyle } from "./secret";

interface Invitation {
  id: string | number;
  note?: string | null;
  by?: string | null;
  expires_us?: number | null;
  uses?: number;
  most_uses?: number | null;
}

interface Bot {
  name: string;
  rate_class?: string;
  created_us?: number;
  expires_us?: number | null;
  last_us?: number | null;
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
            const uses = `used ${one.uses ?? 0}${one.most_uses ? ` of ${one.most_uses}` : ""} times`;
            const until = one.expires_us ? `until ${day(one.expires_us)}` : "without an end";
            return html`<li class="row">
              <span class="grow">
                <b>${one.note ?? `#${one.id}`}</b>
                <span class="soft">${uses}, ${until}, ${one.by ?? ""}</span>
              </span>
              <button
                aria-label="Take back invitation ${one.note ?? one.id}"
                @click=${() => void this.drop(`/invitations/${one.id}`)}
              >
                Take back
              </button>
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
          <label class="field grow">For whom, or why <input name="note" maxlength="200" /></label>
          <label class="field"
            >Days <input name="days" class="short number" type="number" min="1" max="365" value="7"
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
                  <span class="soft">${one.rate_class ?? ""}, last here ${clock(one.last_us)}</span>
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
      note: given.get("note"),
      expires_days: Number(given.get("days")),
      most_uses: Number(given.get("uses")),
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
    const bots = await this.app.api.get<{ bots: Bot[] }>("/bots").catch(() => null);
    if (bots) this.bots = bots.bots;
    this.requestUpdate();
  }
}

customElements.define("esp-invitations", InvitationsPanel);
