/** The parts of the map that the operator wants to see: kept in the browser, and asked of the server. */

import type { AppContext } from "../context";
import type { Stop } from "../state/signal";
import type { HeatMap } from "./heat";
import type { LayersMessage } from "./layers";
import { type MapOptions, readOptions } from "./options";

const KEY = "esplanade-console-map";

export class ShownLayers {
  options: MapOptions = readOptions(localStorage.getItem(KEY));
  private stop: Stop | null = null;

  constructor(
    private readonly app: AppContext,
    private readonly heat: HeatMap,
    private readonly hear: (layers: LayersMessage | null) => void,
  ) {}

  set(change: Partial<MapOptions>): void {
    this.options = { ...this.options, ...change };
    localStorage.setItem(KEY, JSON.stringify(this.options));
    this.begin();
  }

  /** Subscribe to the layers that are shown. */
  begin(): void {
    const { ways, goals, circles } = this.options;
    const before = this.stop;
    const { live } = this.app;
    const wanted = { ways, goals, circles, hz: 2 };
    this.stop =
      ways || goals || circles
        ? live.subscribe("map.layers", wanted, (message: LayersMessage) => {
            this.hear(message);
          })
        : null;
    before?.();
    if (!this.stop) this.hear(null);
  }

  end(): void {
    this.stop?.();
    this.stop = null;
  }

  /** Ask for the heat map that is shown; it may be refused. */
  async askHeat(): Promise<void> {
    const { heat, heatS } = this.options;
    if (heat === "none") this.heat.clear();
    else if (!document.hidden) await this.heat.ask(heat, heatS);
  }
}
