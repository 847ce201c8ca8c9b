/** The own account: its password, and a way into the world as oneself. */

import { html, nothing, type TemplateResult } from "lit";
import { CommandingPanel } from "../commanding";

class AccountPanel extends CommandingPanel {
  private link: string | null = null;

  protected override render(): TemplateResult {
    const me = this.app.state.me.value;
    if (!me) return html`<p class="soft">Nobody is logged in.</p>`;
    return html`
      <p><b>${me.account}</b>, ${me.role}</p>
      <p class="soft">May: ${me.rights.join(", ")}</p>
      <form
        @submit=${(event: SubmitEvent) => {
          event.preventDefault();
          void this.change(event.currentTarget as HTMLFormElement);
        }}
      >
        <fieldset>
          <legend>Another password</legend>
          <input type="text" name="user" autocomplete="username" .value=${me.account} hidden />
          <div class="row">
            <label class="field grow">
              The one until now
              <input name="old" type="password" required autocomplete="current-password" />
            </label>
            <label class="field grow">
              The new one
              <input
                name="new"
                type="password"
                required
                minlength="12"
                autocomplete="new-password"
                aria-describedby="rule"
              />
            </label>
            <button type="submit">Change</button>
          </div>
          <p class="soft" id="rule">At least 12 characters. All other sessions end.</p>
        </fieldset>
      </form>
      <fieldset>
        <legend>Walk in as myself</legend>
        <p>
          An operator has no body. A link that holds for a minute lets you in as a person, with your
          rights.
        </p>
        <button @click=${() => void this.walkIn()}>Make a link</button>
        ${
          this.link === null
            ? nothing
            : html`<a href=${this.link} target="_blank" rel="noopener">Walk in</a>`
        }
      </fieldset>
    `;
  }

  private async change(form: HTMLFormElement): Promise<void> {
    const given = new FormData(form);
    const body = { old: given.get("old"), new: given.get("new") };
    const sent = this.app.api.send("POST", "/password", body).then(() => true);
    if ((await this.attempt(sent)) !== true) return;
    form.reset();
    this.app.toast("You have another password.", "done");
  }

  private async walkIn(): Promise<void> {
    const made = await this.attempt(
      this.app.api.send<{ url: string; seconds: number }>("POST", "/passes", {}),
    );
    if (!made) return;
    this.link = made.url;
    setTimeout(() => {
      this.link = null;
      this.requestUpdate();
    }, made.seconds * 1000);
    this.requestUpdate();
  }
}

customElements.define("esp-account", AccountPanel);
