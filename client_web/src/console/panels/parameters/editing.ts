/** Typing and dragging in the form of parameters, and what becomes of it in the draft. */

import { fromSlider, type NumberField, parsed } from "../../models/fields";
import type { ParameterWork } from "../../models/parameterwork";
import type { RowEvents } from "./row";

export class Editing {
  /** Whether a slider sends while it is dragged. */
  live = false;
  private typing: { name: string; text: string } | null = null;
  private dragged: string | null = null;

  constructor(private readonly changed: () => void) {}

  /** The text in the box of a parameter while somebody types in it. */
  typed(name: string): string | null {
    return this.typing?.name === name ? this.typing.text : null;
  }

  typedOut(): void {
    this.typing = null;
  }

  /** Let a box go on with what holds, once what was typed in it does. */
  applied({ draft }: ParameterWork): void {
    if (this.typing === null || draft.edit(this.typing.name) !== undefined) return;
    if (draft.source(this.typing.name)?.value === Number(this.typing.text)) this.typing = null;
  }

  /** Take an edit out of the draft. */
  drop(work: ParameterWork, name: string): void {
    this.typing = null;
    work.draft.drop(name);
    work.touched();
  }

  /** The effects of the controls of a row. */
  events(
    work: ParameterWork,
    field: NumberField,
    value: number,
    own: boolean,
    clearShadows: (name: string) => void,
  ): RowEvents {
    const { name } = field;
    return {
      slide: (place) => {
        this.typing = null;
        work.edit(name, fromSlider(field, place), this.dragged === name);
        this.dragged = name;
        if (this.live) work.drag();
      },
      slid: () => {
        this.dragged = null;
      },
      type: (text) => {
        const together = this.typing?.name === name;
        this.typing = { name, text };
        const typed = parsed(field, text);
        if (typed !== null) work.edit(name, typed, together);
        else work.draft.mistyped(name, "This is not a number yet.");
        this.changed();
      },
      typedOut: () => {
        const text = this.typing?.text;
        if (this.typing?.name !== name || text === undefined) return;
        this.typing = null;
        if (parsed(field, text) === null) work.draft.mistyped(name, null);
        this.changed();
      },
      step: (by) => {
        this.typing = null;
        const next = Number((value + by).toPrecision(10));
        work.edit(name, Math.min(field.most, Math.max(field.least, next)), true);
      },
      reset: () => {
        this.typing = null;
        if (own) work.edit(name, null);
        else this.drop(work, name);
      },
      drop: () => {
        this.drop(work, name);
      },
      takeTheirs: () => {
        this.drop(work, name);
      },
      keepMine: () => {
        work.draft.keepMine(name);
        work.touched();
      },
      clearShadows: () => {
        clearShadows(name);
      },
    };
  }
}
