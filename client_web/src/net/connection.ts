/** The connection to the server: greets, pings, notices silence, and comes back by itself. */

import { backoffMs } from "./backoff";
import { ServerClock } from "./clock";
import { closing, type Ending } from "./closing";
import { CloseCode, OLDEST_VERSION, VERSION } from "./codes";
import { decodeServer, encodeClient, isSpoken } from "./codec";
import { WireError } from "./errors";
import type { Admission, Arguments, ClientMessage, Look, ServerMessage, Welcome } from "./messages";
import { stated, type Stated } from "./stated";

export type ConnectionState =
  | { phase: "idle" }
  | { phase: "connecting" }
  | { phase: "live" }
  | { phase: "reconnecting"; ending: Ending; attempt: number }
  | { phase: "refused"; ending: Ending };

/** The part of a WebSocket that is used here. */
export type Socket = Pick<
  WebSocket,
  "binaryType" | "readyState" | "onopen" | "onclose" | "onmessage" | "send" | "close"
>;

export interface ConnectionEvents {
  state(state: ConnectionState): void;
  /** Every message but pongs is passed on. The welcome comes before `live`. */
  message(message: ServerMessage): void;
}

/**
 * The first message: a name, the token of an avatar to take up again, the operator key, what lets
 * somebody in, and how the avatar is to look.
 */
export interface Greeting {
  name: string;
  resume: string | null;
  operator: string | null;
  admission: Admission | null;
  look: Look | null;
}

const OPEN = 1;
const PULSE_MS = 1000;
/** The connection is taken for dead after this long without a frame. */
const SILENCE_MS = 5000;
/** So it is after this long, once the device says that it has no network. */
const DOUBTED_SILENCE_MS = 1500;
const GREETING_MS = 10000;

const nowS = (): number => performance.now() / 1000;

export class Connection {
  readonly clock = new ServerClock();
  private state_: ConnectionState = { phase: "idle" };
  private socket: Socket | null = null;
  private greeting: Greeting | null = null;
  private attempt = 0;
  private stated: Stated | null = null;
  /** The version that the next hello asks for: an older one once the newest was refused. */
  private version = VERSION;
  private heardMs = 0;
  private doubted = false;
  private pingNonce = 0;
  private readonly pings = new Map<number, number>();
  private retryTimer: ReturnType<typeof setTimeout> | undefined;
  private pulseTimer: ReturnType<typeof setInterval> | undefined;

  constructor(
    private readonly open: () => Socket,
    private readonly events: ConnectionEvents,
    private readonly random: () => number = Math.random,
  ) {}

  get state(): ConnectionState {
    return this.state_;
  }

  /** Join the world. Later attempts use the token that the last welcome gave. */
  join(greeting: Greeting): void {
    this.leave();
    this.greeting = greeting;
    this.attempt = 0;
    this.change({ phase: "connecting" });
    this.connect();
  }

  /** End the connection for good; the avatar goes with it. */
  leave(): void {
    clearTimeout(this.retryTimer);
    this.drop(CloseCode.NORMAL);
    this.greeting = null;
    if (this.state_.phase !== "idle") this.change({ phase: "idle" });
  }

  /** Try at once instead of waiting, e.g. because the network came back. */
  hurry(): void {
    this.doubted = false;
    if (this.state_.phase !== "reconnecting" || this.socket) return;
    clearTimeout(this.retryTimer);
    this.connect();
  }

  /** The device has no network: the connection has to show soon that it lives all the same. */
  doubt(): void {
    this.doubted = true;
    this.ping();
  }

  /** Look otherwise from now on, also after the connection was lost. */
  wear(look: Look): void {
    if (this.greeting) this.greeting = { ...this.greeting, look };
    this.send({ type: "look", look });
  }

  /** False if the message could not be sent: the connection is not live, or the server too old. */
  send(message: ClientMessage): boolean {
    if (this.state_.phase !== "live" || this.socket?.readyState !== OPEN) return false;
    if (!isSpoken(message.type, this.version)) return false;
    this.socket.send(encodeClient(message));
    return true;
  }

  private connect(): void {
    const socket = this.open();
    this.socket = socket;
    this.stated = null;
    this.doubted = false;
    this.heardMs = performance.now();
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      if (!this.greeting) return;
      socket.send(encodeClient({ type: "hello", ...this.greeting }, this.version));
    };
    socket.onmessage = (event) => {
      this.receive(event.data);
    };
    socket.onclose = (event) => {
      if (event.code === CloseCode.UNSUPPORTED_VERSION && this.version > OLDEST_VERSION) {
        this.version--;
        this.drop();
        this.connect();
      } else this.lost(closing(event.code, this.stated));
    };
    this.pulseTimer = setInterval(() => {
      this.pulse();
    }, PULSE_MS);
  }

  private receive(data: unknown): void {
    this.heardMs = performance.now();
    let message: ServerMessage | null;
    try {
      if (!(data instanceof ArrayBuffer)) throw new WireError("a frame is binary");
      message = decodeServer(data);
    } catch (error) {
      if (!(error instanceof WireError)) throw error;
      const unreadable = { words: error.message };
      this.lost({ cause: "unreadable", stated: unreadable, retry: true });
      return;
    }
    if (message === null) return;
    if (message.type === "pong") {
      this.pong(message.nonce, message.server_time);
      return;
    }
    if (message.type === "error" || message.type === "bye") this.stated = stated(message);
    if (message.type === "notice") this.pace(message.arguments);
    this.events.message(message);
    if (message.type === "welcome") this.welcome(message);
  }

  private welcome(message: Welcome): void {
    this.attempt = 0;
    if (this.greeting) this.greeting = { ...this.greeting, resume: message.resume };
    this.clock.seed(message.server_time, nowS());
    this.change({ phase: "live" });
    this.ping();
  }

  /** The world runs at another pace from now on, if the notice is of that. */
  private pace({ rate, server_time: serverTimeS }: Arguments): void {
    if (typeof rate !== "number" || typeof serverTimeS !== "number") return;
    this.pings.clear();
    this.clock.pace(rate, serverTimeS, nowS());
  }

  private pulse(): void {
    const silentMs = performance.now() - this.heardMs;
    if (this.state_.phase === "live") {
      const longestMs = this.doubted ? DOUBTED_SILENCE_MS : SILENCE_MS;
      if (silentMs > longestMs) this.lost({ cause: "serverSilent", stated: null, retry: true });
      else this.ping();
    } else if (silentMs > GREETING_MS) {
      this.lost({ cause: "noAnswer", stated: null, retry: true });
    }
  }

  private ping(): void {
    const nonce = this.pingNonce++ % 0x1_0000_0000;
    if (this.send({ type: "ping", nonce })) this.pings.set(nonce, nowS());
  }

  private pong(nonce: number, serverTimeS: number): void {
    const sentS = this.pings.get(nonce);
    if (sentS === undefined) return;
    this.pings.delete(nonce);
    this.clock.add(sentS, nowS(), serverTimeS);
  }

  private lost(ending: Ending): void {
    this.drop();
    if (!ending.retry) {
      this.change({ phase: "refused", ending });
      return;
    }
    const attempt = this.attempt++;
    this.retryTimer = setTimeout(
      () => {
        this.connect();
      },
      backoffMs(attempt, this.random),
    );
    this.change({ phase: "reconnecting", ending, attempt });
  }

  /** Without a code the server keeps the avatar for a while. */
  private drop(code?: number): void {
    clearInterval(this.pulseTimer);
    this.pings.clear();
    const socket = this.socket;
    this.socket = null;
    if (!socket) return;
    socket.onopen = socket.onclose = socket.onmessage = null;
    socket.close(code);
  }

  private change(state: ConnectionState): void {
    this.state_ = state;
    this.events.state(state);
  }
}
