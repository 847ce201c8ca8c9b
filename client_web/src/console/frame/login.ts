/** The forms by which an operator comes in: name and password, or the one-time link of the log. */

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { RefusedError } from "../net/api";
import type { Session, Standing } from "../state/session";
import { controls } from "../style/controls";

const LEAST_CHARS = 12;

class Login extends LitElement {
  static override styles = [
    controls,
    css`
      :host {
        display: grid;
        place-items: center;
        position: fixed;
        inset: 0;
        z-index: 20;
        padding: 16px;
        overflow: auto;
        background: var(--ground);
      }

      :host([over]) {
        background: rgb(0 0 0 / 55%);
      }

      form,
      .told {
        width: min(360px, 100vw - 32px);
        display: grid;
        gap: 8px;
        padding: 22px;
        border: 1px solid var(--line);
        border-radius: 12px;
        background: var(--paper);
      }

      h1 {
        margin: 0;
        font-size: 20px;
      }

      p {
        margin: 0;
      }

      label {
        font-weight: 600;
      }

      input,
      button {
        min-height: 36px !important;
      }

      code {
        overflow-wrap: anywhere;
      }
    `,
  ];
  static override properties = {
    session: { attribute: false },
    account: { attribute: false },
    over: { type: Boolean, reflect: true },
    fault: { state: true },
    busy: { state: true },
  };
  declare session: Session;
  /** The operator who was logged in before the session ended. */
  declare account: string;
  /** Whether the page is behind it, since a session has ended. */
  declare over: boolean;
  declare fault: string;
  declare busy: boolean;
  private focused: Standing | null = null;

  constructor() {
    super();
    this.account = "";
    this.over = false;
    this.fault = "";
    this.busy = false;
  }

  /** Bring the keyboard into a form that has just come. */
  override updated(): void {
    const standing = this.session.standing.value;
    if (standing === this.focused) return;
    this.focused = standing;
    const empty = [...this.renderRoot.querySelectorAll("input")].find(({ value }) => value === "");
    empty?.focus();
  }

  protected override render(): TemplateResult {
    switch (this.session.standing.value) {
      case "asking":
        return html`<main class="told"><p role="status">One moment…</p></main>`;
      case "unreachable":
        return html`<main class="told">
          <h1>Esplanade</h1>
          <p role="alert">The server does not answer.</p>
          <button class="main" @click=${() => void this.session.begin()}>Try again</button>
        </main>`;
      case "first":
        return this.first();
      default:
        return this.usual();
    }
  }

  private usual(): TemplateResult {
    const { over, account } = this;
    return html`<div
      role=${over ? "dialog" : "main"}
      aria-labelledby="title"
      aria-modal=${over ? "true" : nothing}
    >
      <form @submit=${this.logIn}>
        <h1 id="title">${over ? "Your session has ended" : "Esplanade: operators"}</h1>
        ${over ? html`<p>Log in again; all that you typed is still there.</p>` : nothing}
        ${
          this.session.untouched.value
            ? html`<p>
                This world has no account yet. Open the one-time link that the server printed when
                it started, or make one on its machine:
                <code>esplanade op user add NAME --role admin</code>
              </p>`
            : nothing
        }
        <label for="name">Name</label>
        <input
          id="name"
          name="name"
          required
          autocomplete="username"
          autocapitalize="none"
          .value=${account}
        />
        <label for="password">Password</label>
        <input
          id="password"
          name="password"
          type="password"
          required
          autocomplete="current-password"
        />
        <button type="submit" ?disabled=${this.busy}>Log in</button>
        <p class="fault" role="alert">${this.fault}</p>
      </form>
    </div>`;
  }

  private first(): TemplateResult {
    return html`<main>
      <form @submit=${this.makeFirst}>
        <h1 id="title">The first account</h1>
        <p>This link works once. The account may do everything, and make others.</p>
        <label for="name">Name</label>
        <input
          id="name"
          name="name"
          required
          maxlength="32"
          pattern="[a-z][a-z0-9._\\-]*"
          title="Small letters, digits and . _ -, beginning with a letter"
          autocomplete="username"
          autocapitalize="none"
        />
        <label for="password">Password, of ${LEAST_CHARS} characters or more</label>
        <input
          id="password"
          name="password"
          type="password"
          required
          minlength=${LEAST_CHARS}
          autocomplete="new-password"
        />
        <label for="again">The same again</label>
        <input id="again" name="again" type="password" required autocomplete="new-password" />
        <button type="submit" ?disabled=${this.busy}>Make it and log in</button>
        <button type="button" class="plain" @click=${() => void this.session.dropFirst()}>
          I have an account
        </button>
        <p class="fault" role="alert">${this.fault}</p>
      </form>
    </main>`;
  }

  private readonly logIn = (event: SubmitEvent): void => {
    const { name, password } = this.fields(event);
    void this.come(() => this.session.logIn(name, password));
  };

  private readonly makeFirst = (event: SubmitEvent): void => {
    const { name, password, again } = this.fields(event);
    if (password === again) void this.come(() => this.session.makeFirst(name, password));
    else this.fault = "the two passwords differ";
  };

  private fields(event: SubmitEvent): { name: string; password: string; again: string } {
    event.preventDefault();
    const value = (id: string): string =>
      this.renderRoot.querySelector<HTMLInputElement>(`#${id}`)?.value ?? "";
    return { name: value("name").trim(), password: value("password"), again: value("again") };
  }

  private async come(ask: () => Promise<void>): Promise<void> {
    this.busy = true;
    this.fault = "";
    try {
      await ask();
    } catch (error) {
      if (!(error instanceof RefusedError)) throw error;
      this.fault = error.message;
      this.renderRoot.querySelector<HTMLInputElement>("#password")?.select();
    } finally {
      this.busy = false;
    }
  }
}

customElements.define("esp-login", Login);
