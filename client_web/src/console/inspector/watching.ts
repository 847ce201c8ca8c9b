/** The facts of one actor that is looked at: asked of the server, and told by it. */

import type { AppContext } from "../context";
import type { LiveMessage } from "../net/live";
import { RefusedError } from "../net/api";
import type {
  ActorDetails,
  Blocker,
  Cost,
  PathPoint,
  Point,
  ReasonName,
  Trace,
  Why,
} from "../net/types";
import type { Stop } from "../state/signal";

const WHY_MS = 5000;
const HZ = 5;

export interface ActorMessage extends LiveMessage {
  tick: number;
  x: number;
  y: number;
  z: number;
  speed: number;
  reason: ReasonName;
  since_s?: number;
  blocker: Blocker | null;
  outcome?: string | null;
  in_the_way?: Blocker | null;
  behaviour: Readonly<Record<string, unknown>> | null;
  path: readonly PathPoint[] | null;
  cost: Cost | null;
  previous: { path: readonly PathPoint[]; cost: Cost | null } | null;
  goal?: Point | null;
}

export class WatchedActor {
  details: ActorDetails | null = null;
  now: ActorMessage | null = null;
  why: Why = { spans: [], moments: [] };
  trace: Trace | null = null;
  private readonly stops: Stop[] = [];
  private ended = false;

  constructor(
    readonly id: string,
    private readonly app: AppContext,
    private readonly changed: () => void,
  ) {
    const timer = setInterval(() => void this.askWhy(), WHY_MS);
    this.stops.push(
      () => {
        clearInterval(timer);
      },
      app.live.subscribe(`actor:${id}`, { hz: HZ }, (message: ActorMessage) => {
        this.now = message;
        changed();
      }),
      app.state.revision.watch(() => void this.askDetails()),
    );
    void this.askDetails();
    void this.askWhy();
  }

  end(): void {
    this.ended = true;
    for (const stop of this.stops) stop();
  }

  async askTrace(): Promise<void> {
    this.trace = await this.ask<Trace>("/trace");
    this.changed();
  }

  private async askDetails(): Promise<void> {
    const details = await this.ask<ActorDetails>("");
    if (!details) return;
    this.details = details;
    this.changed();
  }

  private async askWhy(): Promise<void> {
    if (document.hidden) return;
    const why = await this.ask<Why>("/why");
    if (!why) return;
    this.why = why;
    this.changed();
  }

  private async ask<T>(tail: string): Promise<T | null> {
    const id = this.id.split("/").map(encodeURIComponent).join("/");
    try {
      const found = await this.app.api.get<T>(`/actors/${id}${tail}`);
      return this.ended ? null : found;
    } catch (error) {
      if (!(error instanceof RefusedError)) throw error;
      // An actor may have been removed meanwhile; that its map shows no more says so.
      if (!this.ended && error.status !== 404) this.app.toast(error.message, "fault");
      return null;
    }
  }
}
