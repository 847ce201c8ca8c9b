/** The live interface: one socket, which comes back by itself with the same subscriptions. */

import { backoffMs } from "../../net/backoff";
import { Signal, type Stop } from "../state/signal";
import { type Arguments, merged } from "./merging";
import type { Fault } from "./types";

export type LiveMessage = Readonly<Record<string, unknown>> & { readonly channel: string };
export type Phase = "off" | "connecting" | "on";

/** The server takes no more subscriptions of one socket. */
export const MOST_SUBSCRIPTIONS = 16;
/** A socket that has stood for this long was a good one. */
const STOOD_MS = 10_000;

interface Listener {
  arguments: Arguments;
  hear: (message: never) => void;
}

export interface Surroundings {
  open: (url: string) => WebSocket;
  random: () => number;
  after: (ms: number, call: () => void) => Stop;
  now: () => number;
}

const BROWSER: Surroundings = {
  open: (url) => new WebSocket(url),
  random: Math.random,
  after: (ms, call) => {
    const timer = setTimeout(call, ms);
    return () => {
      clearTimeout(timer);
    };
  },
  now: () => performance.now(),
};

export class Live {
  readonly phase = new Signal<Phase>("off");
  /** The close code of the socket before. */
  readonly closed = new Signal<number | null>(null);
  /** Asked before each attempt but the first: whether there is still a session. */
  mayConnect: () => Promise<boolean> = () => Promise.resolve(true);
  /** Called when the server does not let something be subscribed to. */
  refused: (faults: readonly Fault[]) => void = () => undefined;

  private readonly listeners = new Map<string, Set<Listener>>();
  private readonly asked = new Map<string, string>();
  private readonly frameListeners = new Set<(frame: ArrayBuffer) => void>();
  private socket: WebSocket | null = null;
  private attempts = 0;
  private wanted = false;
  private stopWaiting: Stop | null = null;

  constructor(
    private readonly url: string,
    private readonly around: Surroundings = BROWSER,
  ) {}

  start(): void {
    if (this.wanted) return;
    this.wanted = true;
    this.connect();
  }

  stop(): void {
    this.wanted = false;
    this.stopWaiting?.();
    this.stopWaiting = null;
    this.socket?.close(1000);
    this.socket = null;
    this.asked.clear();
    this.phase.value = "off";
  }

  /** Hear the messages of a channel until what is returned is called. */
  subscribe(channel: string, wanted: Arguments, hear: (message: never) => void): Stop {
    const listener: Listener = { arguments: wanted, hear };
    const all = this.listeners.get(channel) ?? new Set();
    if (!this.listeners.has(channel) && this.listeners.size >= MOST_SUBSCRIPTIONS) {
      throw new Error(`more than ${MOST_SUBSCRIPTIONS} channels at once`);
    }
    this.listeners.set(channel, all.add(listener));
    this.ask(channel);
    return () => {
      all.delete(listener);
      if (all.size === 0) this.listeners.delete(channel);
      this.ask(channel);
    };
  }

  /** Hear the binary frames of the map. */
  frames(hear: (frame: ArrayBuffer) => void): Stop {
    this.frameListeners.add(hear);
    return () => this.frameListeners.delete(hear);
  }

  private connect(): void {
    this.phase.value = "connecting";
    const socket = this.around.open(this.url);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    let openedMs = Number.POSITIVE_INFINITY;
    socket.addEventListener("open", () => {
      if (socket !== this.socket) return;
      openedMs = this.around.now();
      this.asked.clear();
      this.phase.value = "on";
      for (const channel of this.listeners.keys()) this.ask(channel);
    });
    socket.addEventListener("message", (event: MessageEvent<unknown>) => {
      if (socket === this.socket) this.take(event.data);
    });
    socket.addEventListener("close", (event: CloseEvent) => {
      if (socket !== this.socket) return;
      this.socket = null;
      this.closed.value = event.code;
      if (this.around.now() - openedMs > STOOD_MS) this.attempts = 0;
      if (this.wanted) this.wait();
    });
  }

  private wait(): void {
    this.phase.value = "connecting";
    const ms = backoffMs(this.attempts++, this.around.random);
    this.stopWaiting = this.around.after(ms, () => {
      void this.mayConnect().then((may) => {
        if (!this.wanted || this.socket) return;
        if (may) this.connect();
        else this.wait();
      });
    });
  }

  /** Tell the server what is wanted of a channel now, if it does not know. */
  private ask(channel: string): void {
    if (this.socket?.readyState !== 1) return;
    const listeners = this.listeners.get(channel);
    if (!listeners) {
      if (this.asked.delete(channel)) this.socket.send(JSON.stringify({ unsubscribe: channel }));
      return;
    }
    const wanted = merged([...listeners].map((listener) => listener.arguments));
    const text = JSON.stringify({ subscribe: channel, ...wanted });
    if (this.asked.get(channel) === text) return;
    this.asked.set(channel, text);
    this.socket.send(text);
  }

  private take(data: unknown): void {
    if (data instanceof ArrayBuffer) {
      for (const hear of this.frameListeners) hear(data);
      return;
    }
    if (typeof data !== "string") return;
    const message = JSON.parse(data) as LiveMessage & { faults?: readonly Fault[] };
    if (message.faults) {
      this.refused(message.faults);
      return;
    }
    for (const listener of this.listeners.get(message.channel) ?? []) {
      listener.hear(message as never);
    }
  }
}
