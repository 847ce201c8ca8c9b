/** Puts together what the panels are given. */

import type { AppContext } from "../context";
import { Avatars } from "../map/avatars";
import { addressesOf } from "../net/addresses";
import { Api } from "../net/api";
import { Live } from "../net/live";
import { watchScheme } from "../state/scheme";
import { Shortcuts } from "../state/shortcuts";
import { State } from "../state/state";

export function makeContext(page: URL, shell: Pick<AppContext, "toast" | "show">): AppContext {
  const addresses = addressesOf(page);
  const state = new State();
  return {
    api: new Api(addresses.api),
    live: new Live(addresses.live),
    state,
    avatars: new Avatars(),
    shortcuts: new Shortcuts(),
    scheme: watchScheme(),
    ...shell,
    choose: (ids) => {
      state.chosen.value = ids === null ? [] : typeof ids === "string" ? [ids] : ids;
      if (state.chosen.value.length === 0) state.following.value = false;
    },
  };
}
