/** A server that lives in the test: sockets whose other end the test holds. */

import { decode, encode } from "@msgpack/msgpack";
import { VERSION } from "../../src/net/codes";
import { bare } from "../scenes";
import type { Socket } from "../../src/net/connection";
import type { Welcome } from "../../src/net/messages";

export class FakeSocket implements Socket {
  binaryType: BinaryType = "blob";
  readyState: Socket["readyState"] = WebSocketState.CONNECTING;
  onopen: Socket["onopen"] = null;
  onclose: Socket["onclose"] = null;
  onmessage: Socket["onmessage"] = null;
  /** The messages that the client sent, as [code, fields]. */
  readonly received: [number, Record<string, unknown>][] = [];
  closedWith: number | "no code" | null = null;

  send(data: Parameters<Socket["send"]>[0]): void {
    this.received.push(decode(data as Uint8Array) as [number, Record<string, unknown>]);
  }

  close(code?: number): void {
    this.readyState = WebSocketState.CLOSED;
    this.closedWith ??= code ?? "no code";
  }

  accept(): void {
    this.readyState = WebSocketState.OPEN;
    this.onopen?.call(this as unknown as WebSocket, new Event("open"));
  }

  say(code: number, fields: object): void {
    this.deliver(encode([code, fields]).slice().buffer);
  }

  deliver(data: unknown): void {
    this.onmessage?.call(this as unknown as WebSocket, { data } as MessageEvent);
  }

  end(code: number): void {
    this.readyState = WebSocketState.CLOSED;
    this.onclose?.call(this as unknown as WebSocket, { code } as CloseEvent);
  }
}

export const WebSocketState = { CONNECTING: 0, OPEN: 1, CLOSED: 3 } as const;

export const WELCOME: Welcome = {
  type: "welcome",
  version: VERSION,
  id: 7,
  name: "Ann",
  resume: "token-1",
  resumed: false,
  scene: { ...bare, bounds: [0, 0, 10, 10] },
  tick: 100,
  tick_rate: 20,
  server_time: 5,
  resume_seconds: 30,
  radius: 0.25,
  clearance: 0.25,
  body_height: 1.8,
  step_height: 0.6,
  max_speed: 2.5,
  walk_speed: 1.4,
  origin: [0, 0],
  doors: {},
  operator: false,
};
