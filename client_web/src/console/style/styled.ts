/**
 * Sets properties of an element's style, `<div ${styled({ top: "4px" })}>`.
 *
 * Lit's own `styleMap` writes the attribute when it draws for the first time, which the content
 * security policy forbids.
 */

import { noChange } from "lit";
import { directive, Directive, type ElementPart, type PartInfo, PartType } from "lit/directive.js";

export type Styles = Readonly<Record<string, string | number>>;

class Styled extends Directive {
  private before: Styles = {};

  constructor(part: PartInfo) {
    super(part);
    if (part.type !== PartType.ELEMENT) throw new Error("styled() stands by itself in a tag");
  }

  override render(styles: Styles): unknown {
    this.before = styles;
    return noChange;
  }

  override update(part: ElementPart, [styles]: [Styles]): unknown {
    const { style } = part.element as HTMLElement;
    for (const name of Object.keys(this.before)) {
      if (!(name in styles)) style.removeProperty(name);
    }
    for (const [name, value] of Object.entries(styles)) {
      if (this.before[name] !== value) style.setProperty(name, String(value));
    }
    this.before = styles;
    return noChange;
  }
}

export const styled = directive(Styled);
