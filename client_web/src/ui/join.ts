/** The dialog before one joins: it asks for a name, and says why one is not in the world. */

import { MAX_NAME_CHARS } from "../net/codes";
import type { Wording } from "../language/phrase";
import { words } from "../language/words";
import { byId } from "./dom";
import { tooLong } from "./lengths";
import { write } from "./writing";

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
      this.tell(() => this.faultOf(name));
      if (this.faultOf(name) !== "") {
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

  open(reason: () => Wording = () => ""): void {
    this.busy(false);
    this.tell(reason);
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
    this.tell(() => "");
    this.password.value = "";
    this.wanted = false;
    this.dialog.close();
  }

  /** Say why joining takes long. */
  wait(reason: () => Wording): void {
    this.tell(() => words.door.tryingAgain(reason()));
  }

  /** Show that the server is being asked. */
  busy(busy: boolean): void {
    this.button.disabled = busy;
    write(this.button, () => (busy ? words.door.comingIn : words.door.comeIn));
  }

  private tell(reason: () => Wording): void {
    // The same words again are said again.
    this.reason.replaceChildren();
    write(this.reason, reason);
  }

  /** The fault of a name, or that the password is missing; an empty text if all is well. */
  private faultOf(name: string): Wording {
    if (name === "") return words.door.noName;
    if (this.password.required && this.password.value === "") return words.door.noPassword;
    return tooLong(name, MAX_NAME_CHARS) ?? "";
  }
}
