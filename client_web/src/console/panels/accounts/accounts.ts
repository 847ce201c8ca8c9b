/** Accounts of operators: roles, passwords, and tokens of scripts, which are shown once. */

import { css, html, nothing, type TemplateResult } from "lit";
import { clock, day } from "../../models/times";
import { CommandingPanel } from "../commanding";
import { secret, secretStyle } from "./secret";

interface Token {
  name: string;
  rights: readonly string[];
  expires_us: number;
  last_us: number | null;
}

interface Account {
  name: string;
  role: string;
  created_us: number;
  last_us: number | null;
  has_password: boolean;
  tokens: readonly Token[];
}

const ROLES = ["viewer", "moderator", "tuner", "director", "admin", "auditor"];

class AccountsPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    secretStyle,
    css`
      li.account {
        padding: 6px 0;
        border-bottom: 1px solid var(--line);
      }
    `,
  ];
  private accounts: readonly Account[] = [];
  /** The token that was made last, which nobody can be told again. */
  private made: { account: string; token: string } | null = null;
  private removing = "";

  protected override begin(): void {
    this.hearAbout(/account|user|token/, () => void this.load());
    void this.load();
  }

  protected override render(): TemplateResult {
    return html`
      ${this.refused()}
      ${
        this.made
          ? secret(
              `The token of ${this.made.account}. It is shown this once.`,
              this.made.token,
              this.app,
              () => {
                this.made = null;
                this.requestUpdate();
              },
            )
          : nothing
      }
      <ul class="plain" aria-label="Accounts">
        ${this.accounts.map((account) => this.row(account))}
      </ul>
      <form
        @submit=${(event: SubmitEvent) => {
          event.preventDefault();
          void this.add(event.currentTarget as HTMLFormElement);
        }}
      >
        <fieldset>
          <legend>Add an account</legend>
          <div class="row">
            <label class="field grow">
              Name
              <input
                name="name"
                required
                autocomplete="off"
                pattern="[a-z][a-z0-9._\\-]{0,31}"
                title="small letters, digits and . _ -, a letter first"
              />
            </label>
            <label class="field">Role ${roles("role", "tuner")}</label>
            <label class="field grow">
              Password (empty: tokens only)
              <input name="password" type="password" minlength="12" autocomplete="new-password" />
            </label>
            <button type="submit">Add</button>
          </div>
        </fieldset>
      </form>
    `;
  }

  private row(account: Account): TemplateResult {
    const { name } = account;
    return html`<li class="account">
      <div class="row">
        <b class="grow">${name}</b>
        <label>
          <span class="visually-hidden">Role of ${name}</span>
          <select
            @change=${(event: Event) => {
              const role = (event.currentTarget as HTMLSelectElement).value;
              void this.change(name, { role }, `${name} is ${role} from the next command on.`);
            }}
          >
            ${ROLES.map((role) => html`<option ?selected=${role === account.role}>${role}</option>`)}
          </select>
        </label>
        <button
          aria-label=${this.removing === name ? `Really remove? ${name}` : `Remove ${name}`}
          @click=${() => {
            if (this.removing === name) void this.takeAway(name);
            else this.removing = name;
            this.requestUpdate();
          }}
        >
          ${this.removing === name ? "Really remove?" : "Remove"}
        </button>
      </div>
      <div class="soft">
        since ${day(account.created_us)}, last here ${clock(account.last_us)},
        ${account.has_password ? "has a password" : "tokens only"}
      </div>
      <details>
        <summary>${account.tokens.length} tokens, password</summary>
        <ul class="plain">
          ${account.tokens.map(
            (token) =>
              html`<li class="row">
                <span class="grow">
                  <b>${token.name}</b>
                  <span class="soft"
                    >until ${day(token.expires_us)}, last used ${clock(token.last_us)};
                    ${token.rights.join(" ")}</span
                  >
                </span>
                <button
                  aria-label="Revoke ${token.name} of ${name}"
                  @click=${() => void this.revoke(name, token.name)}
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
            void this.token(name, event.currentTarget as HTMLFormElement);
          }}
        >
          <label class="field">Token's name <input name="name" required maxlength="64" /></label>
          <label class="field"
            >Days
            <input name="days" class="short number" type="number" min="1" max="365" value="90"
          /></label>
          <label class="field grow"
            >Rights (empty: all of the account) <input name="rights" placeholder="watch parameters"
          /></label>
          <button type="submit">Make</button>
        </form>
        <form
          class="row"
          @submit=${(event: SubmitEvent) => {
            event.preventDefault();
            void this.password(name, event.currentTarget as HTMLFormElement);
          }}
        >
          <label class="field grow">
            Another password
            <input
              name="password"
              type="password"
              required
              minlength="12"
              autocomplete="new-password"
            />
          </label>
          <button type="submit">Set</button>
        </form>
      </details>
    </li>`;
  }

  private async add(form: HTMLFormElement): Promise<void> {
    const given = new FormData(form);
    const password = given.get("password") as string;
    const body = {
      name: given.get("name"),
      role: given.get("role"),
      password: password === "" ? null : password,
    };
    if (await this.send("POST", "/accounts", body, "The account is there.")) form.reset();
  }

  private async change(name: string, body: object, done: string): Promise<boolean> {
    return await this.send("PATCH", `/accounts/${encodeURIComponent(name)}`, body, done);
  }

  private async password(name: string, form: HTMLFormElement): Promise<void> {
    const password = new FormData(form).get("password");
    const done = `${name} has another password; its sessions have ended.`;
    if (await this.change(name, { password }, done)) form.reset();
  }

  private async token(account: string, form: HTMLFormElement): Promise<void> {
    const given = new FormData(form);
    const rights = (given.get("rights") as string).split(/[\s,]+/).filter(Boolean);
    const body: Record<string, unknown> = {
      name: given.get("name"),
      expires_days: Number(given.get("days")),
    };
    if (rights.length > 0) body["rights"] = rights;
    const path = `/accounts/${encodeURIComponent(account)}/tokens`;
    const made = await this.attempt(this.app.api.send<{ token: string }>("POST", path, body));
    if (!made) return;
    this.made = { account, token: made.token };
    form.reset();
    await this.load();
  }

  private async revoke(account: string, token: string): Promise<void> {
    const path = `/accounts/${encodeURIComponent(account)}/tokens/${encodeURIComponent(token)}`;
    await this.send("DELETE", path, undefined, `${token} opens nothing any more.`);
  }

  private async takeAway(name: string): Promise<void> {
    this.removing = "";
    await this.send(
      "DELETE",
      `/accounts/${encodeURIComponent(name)}`,
      undefined,
      `${name} is gone.`,
    );
  }

  private async send(
    method: "POST" | "PATCH" | "DELETE",
    path: string,
    body: unknown,
    done: string,
  ): Promise<boolean> {
    const sent = this.app.api.send(method, path, body).then(() => true);
    const isDone = (await this.attempt(sent)) === true;
    if (isDone) this.app.toast(done, "done");
    await this.load();
    return isDone;
  }

  private async load(): Promise<void> {
    const found = await this.ask<{ accounts: Account[] }>("/accounts");
    if (found) this.accounts = found.accounts;
    this.requestUpdate();
  }
}

function roles(name: string, usual: string): TemplateResult {
  return html`<select name=${name}>
    ${ROLES.map((role) => html`<option ?selected=${role === usual}>${role}</option>`)}
  </select>`;
}

customElements.define("esp-accounts", AccountsPanel);
