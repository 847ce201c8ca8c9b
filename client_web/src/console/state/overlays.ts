/** The drawings of panels on the map: lines, marks and values of cells. */

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
  /** `most` is the value that has the full colour, if it is not that of the raster. */
  raster?: Raster & { z_m: number; most?: number };
}
