/** Room for labels on the screen: one that would be printed over another finds none. */

export interface LabelBox {
  /** The middle of its lower edge, pixels. */
  x: number;
  y: number;
  width: number;
  height: number;
}

/** Labels may come as near to each other as this, pixels. */
const GAP_PX = 1;

export class LabelRoom {
  private readonly taken: LabelBox[] = [];

  clear(): void {
    this.taken.length = 0;
  }

  /** Take the room of a box, if nothing of it is taken; returns whether it was free. */
  take(box: LabelBox): boolean {
    if (this.taken.some((other) => overlap(box, other))) return false;
    this.taken.push(box);
    return true;
  }
}

function overlap(a: LabelBox, b: LabelBox): boolean {
  const apartX = Math.abs(a.x - b.x) - (a.width + b.width) / 2;
  const apartY = Math.abs(a.y - a.height / 2 - (b.y - b.height / 2)) - (a.height + b.height) / 2;
  return apartX < GAP_PX && apartY < GAP_PX;
}
