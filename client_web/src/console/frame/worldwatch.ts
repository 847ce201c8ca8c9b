/** Keeps what is known of the world as a whole up to date while somebody is logged in. */

import type { AppContext } from "../context";
import type { MapMessage } from "../map/avatars";
import { RefusedError } from "../net/api";
import type { World, Zones } from "../net/types";
import type { Stop } from "../state/signal";

const AGAIN_MS = 5000;
/** Changes that come close together are asked about once. */
const SETTLE_MS = 150;

/** Begin to listen; what is returned ends it. */
export function watchWorld(app: AppContext): Stop {
  const { api, live, state, avatars } = app;
  let settling: ReturnType<typeof setTimeout> | undefined;
  const ask = async (): Promise<void> => {
    try {
      const [world, zones] = await Promise.all([
        api.get<World>("/world"),
        api.get<Zones>("/zones"),
      ]);
      state.world.value = world;
      state.zones.value = zones;
      state.revision.value = world.revision;
    } catch (error) {
      if (!(error instanceof RefusedError)) throw error;
    }
  };
  const soon = (): void => {
    clearTimeout(settling);
    settling = setTimeout(() => void ask(), SETTLE_MS);
  };
  const timer = setInterval(() => void ask(), AGAIN_MS);
  const stops = [
    live.subscribe("map", { hz: 10 }, (message: MapMessage) => {
      avatars.hear(message);
    }),
    live.frames((frame) => {
      avatars.take(frame, performance.now() / 1000);
    }),
    live.subscribe("changes", {}, soon),
    live.phase.watch((phase) => {
      if (phase === "on") soon();
    }),
  ];
  void ask();
  return () => {
    clearInterval(timer);
    clearTimeout(settling);
    for (const stop of stops) stop();
    avatars.clear();
  };
}
