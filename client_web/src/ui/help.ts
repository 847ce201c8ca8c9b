/** The help dialog with its settings: the fineness of drawing, and the overlay of skeletons. */

import { byId } from "./dom";

const CHOICE_KEY = "esplanade.drawing";
const CHOICES = ["automatic", "fine", "fast"] as const;
export type DrawingChoice = (typeof CHOICES)[number];

export function storedChoice(): DrawingChoice {
  const stored = localStorage.getItem(CHOICE_KEY);
  return CHOICES.find((choice) => choice === stored) ?? "automatic";
}

export function setUpHelp(
  changed: (choice: DrawingChoice) => void,
  skeletons: (shown: boolean) => void,
): void {
  const dialog = byId("help", HTMLDialogElement);
  const drawing = byId("drawing", HTMLSelectElement);
  drawing.value = storedChoice();
  drawing.addEventListener("change", () => {
    localStorage.setItem(CHOICE_KEY, drawing.value);
    changed(storedChoice());
  });
  const shown = byId("skeletons", HTMLInputElement);
  shown.addEventListener("change", () => {
    skeletons(shown.checked);
  });
  byId("help-open", HTMLButtonElement).addEventListener("click", () => {
    dialog.showModal();
  });
  byId("help-close", HTMLButtonElement).addEventListener("click", () => {
    dialog.close();
  });
}
