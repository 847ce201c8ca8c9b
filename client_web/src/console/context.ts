/** The context that every panel is given. */

import type { Avatars } from "./map/avatars";
import type { Api } from "./net/api";
import type { Live } from "./net/live";
import type { Shortcuts } from "./state/shortcuts";
import type { Scheme } from "./state/scheme";
import type { Signal } from "./state/signal";
import type { State } from "./state/state";

export type Mood = "note" | "done" | "fault";

export interface AppContext {
  readonly api: Api;
  readonly live: Live;
  readonly state: State;
  /** Everybody in the world, as the live map tells. */
  readonly avatars: Avatars;
  readonly shortcuts: Shortcuts;
  readonly scheme: Signal<Scheme>;
  /** Choose actors (`main/actor-1`) or people (`person:12`); null chooses nobody. */
  choose(ids: string | readonly string[] | null): void;
  /** Tell the operator something that has happened; faults stay until they are closed. */
  toast(text: string, mood?: Mood): void;
  /** Bring a panel to the front, opening it where it was shut. */
  show(panel: string): void;
}
