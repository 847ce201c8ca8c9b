/** The dialog before one joins: it asks for a name, and says why one is not in the world. */

import { MAX_NAME_CHARS } from "../net/codes";
import { byId } from "./dom";
import { tooLong } from "./lengths";

const NAME_KEY = "esplanade.name";

export class JoinDialog {
  private readonly dialog = byId("join", HTMLDialogElement);
  private readonly form = byId("join-form", HTMLFormElement);
  private readonly name = byId("join-name", HTMLInputElement);
  private readonly reason = byId("join-reason", HTMLElement);
  private readonly button = byId("join-button", HTMLButtonElement);

  /** Whether the dialog is to be seen. */
  private wanted = false;
  private readonly secret = byId("join-secret", HTMLElement);
  private readonly password = byId("join-password", HTMLInputElement);

  /** `join` is called with the name, and with the password of the place or an empty text. */
  constructor(join: (name: string, password: string) => void) {
    this.name.value = localStorage.getItem(NAME_KEY) ?? "";
    this.form.addEventListener("submit", (event) => {
      event.preventDefault();
      const name = this.name.value.trim();
      const fault = this.faultOf(name);
      this.reason.textContent = fault;
      if (fault !== "") {
        this.name.select();
        return;
      }
      localStorage.setItem(NAME_KEY, name);
      join(name, this.password.value);
    });
    // Nobody is in the world without a name. A browser closes a dialog at the second Esc whatever
    // its page says to the first.
    this.dialog.addEventListener("cancel", (event) => {
      event.preventDefault();
    });
    this.dialog.addEventListener("close", () => {
      if (this.wanted) this.dialog.showModal();
    });
  }

  open(reason = ""): void {
    this.busy(false);
    this.reason.textContent = reason;
    this.wanted = true;
    if (!this.dialog.open) this.dialog.showModal();
    if (this.secret.hidden) this.name.select();
    else this.password.select();
  }

  /** Ask for the password of the place from now on. */
  askPassword(): void {
    this.secret.hidden = false;
    this.password.required = true;
  }

  close(): void {
    this.busy(false);
    this.reason.textContent = "";
    this.password.value = "";
    this.wanted = false;
    this.dialog.close();
  }

  /** Say why joining takes long. */
  wait(reason: string): void {
    this.reason.textContent = `${reason} Trying again…`;
  }

  /** Show that the server is being asked. */
  busy(busy: boolean): void {
    this.button.disabled = busy;
    this.button.textContent = busy ? "Coming in…" : "Come in";
  }

  /** The fault of a name, or that the password is missing; an empty text if all is well. */
  private faultOf(name: string): string {
    if (name === "") return "Please give a name that one can see.";
    if (this.password.required && this.password.value === "") return "Please give the password.";
    return tooLong(name, MAX_NAME_CHARS) ?? "";
  }
}
