/** What the panel of differences has in its columns; others may ask for a comparison. */

import { Signal } from "../state/signal";

export const comparing = new Signal<readonly string[]>(["default", "world"]);
