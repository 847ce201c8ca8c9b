/** The columns of the panel of differences; others may ask for a comparison. */

import { Signal } from "../state/signal";

export const comparing = new Signal<readonly string[]>(["default", "world"]);
