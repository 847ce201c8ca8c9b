/** The help dialog with the one setting there is: how finely the world is drawn. */

import { byId } from "./dom";

const CHOICE_KEY = "esplanade.drawing";
const CHOICES = ["automatic", "fine", "fast"] as const;
export type DrawingChoice = (typeof CHOICES)[number];

export function storedChoice(): DrawingChoice {
  const stored = localStorage.getItem(CHOICE_KEY);
  return CHOICES.find((choice) => choice === stored) ?? "automatic";
}

export function setUpHelp(changed: (choice: DrawingChoice) => void): void {
  const dialog = byId("help", HTMLDialogElement);
  const drawing = byId("drawing", HTMLSelectElement);
  drawing.value = storedChoice();
  drawing.addEventListener("change", () => {
    localStorage.setItem(CHOICE_KEY, drawing.value);
    changed(storedChoice());
  });
  byId("help-open", HTMLButtonElement).addEventListener("click", () => {
    dialog.showModal();
  });
  byId("help-close", HTMLButtonElement).addEventListener("click", () => {
    dialog.close();
  });
}
