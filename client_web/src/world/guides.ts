/** Guides, who are found by the sign that they hold up. */

import type { Look } from "../net/messages";

/** Whether somebody of this look holds up the sign of guides. */
export function hasSign(look: Look | null): boolean {
  return look?.[6] === 1;
}
