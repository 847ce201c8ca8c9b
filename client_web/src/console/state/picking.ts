/** Places that an operator points at on the map, for a panel that asks for them. */

import type { Point } from "../net/types";

export interface Picking {
  /** The question, in a sentence. */
  readonly text: string;
  /** Places that are taken already, drawn as a line in their order. */
  readonly points: readonly Point[];
  /** Whether the line goes back to its beginning. */
  readonly closed: boolean;
  take(point: Point): void;
  end(): void;
}
