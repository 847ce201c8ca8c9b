/** Asks the operator for a point, a line or a ring on the map. */

import type { AppContext } from "../context";
import type { Point } from "../net/types";

/** The points that were clicked; null where the operator wants none after all. */
export function pick(
  app: AppContext,
  text: string,
  kind: "point" | "line" | "ring",
): Promise<readonly Point[] | null> {
  const { picking } = app.state;
  picking.value?.end();
  app.show("map");
  return new Promise((resolve) => {
    const points: Point[] = [];
    const end = (): void => {
      picking.value = null;
      resolve(points.length > 0 ? points : null);
    };
    const ask = (): void => {
      picking.value = {
        text: kind === "point" ? text : `${text} (${points.length} so far)`,
        points: [...points],
        closed: kind === "ring",
        take: (point) => {
          points.push(point);
          if (kind === "point") end();
          else ask();
        },
        end,
      };
    };
    ask();
  });
}
