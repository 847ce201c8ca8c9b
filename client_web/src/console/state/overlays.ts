/** What panels have drawn on the map: lines, marks and values of cells. */

import type { Point, Raster } from "../net/types";

export interface Line {
  points: readonly Point[];
  colour: string;
  widthPx: number;
  dashed?: boolean;
  closed?: boolean;
  /** A ring is filled with its colour, thinly. */
  filled?: boolean;
}

/** Many short lines of one colour. */
export interface Segments {
  pairs: readonly (readonly [Point, Point])[];
  colour: string;
}

export interface Overlay {
  lines: readonly Line[];
  segments?: readonly Segments[];
  raster?: Raster & { z_m: number };
}
