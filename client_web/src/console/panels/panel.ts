/** The base of all panels: an element that is given the page's context. */

import { LitElement } from "lit";
import type { AppContext } from "../context";
import { RefusedError } from "../net/api";
import type { Arguments } from "../net/merging";
import type { Signal, Stop } from "../state/signal";
import { controls } from "../style/controls";

export abstract class Panel extends LitElement {
  static override styles = [controls];
  static override properties = { app: { attribute: false } };
  declare app: AppContext;
  private stops: Stop[] = [];
  private begun = false;

  /** Called when the panel comes into the page; what it watches and hears here ends when it goes. */
  protected begin(): void {
    // A panel that only draws needs nothing.
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.beginOnce();
  }

  override willUpdate(): void {
    this.beginOnce();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    for (const stop of this.stops) stop();
    this.stops = [];
    this.begun = false;
  }

  /** Call this, or draw the panel anew, with every change of a signal. */
  protected watch<T>(signal: Signal<T>, tell?: (value: T) => void): void {
    this.stops.push(
      signal.watch(
        tell ??
          (() => {
            this.requestUpdate();
          }),
      ),
    );
  }

  /** Hear a channel of the live interface. */
  protected hear(channel: string, wanted: Arguments, hear: (message: never) => void): void {
    this.stops.push(this.app.live.subscribe(channel, wanted, hear));
  }

  /** Have something undone when the panel goes. */
  protected atEnd(stop: Stop): void {
    this.stops.push(stop);
  }

  /** Call again and again while the page is seen, until the panel goes. */
  protected every(ms: number, call: () => void): void {
    const timer = setInterval(() => {
      if (!document.hidden) call();
    }, ms);
    this.atEnd(() => {
      clearInterval(timer);
    });
  }

  /** Wait for something that may be refused, and tell the operator if it is. */
  protected async attempt<T>(asked: Promise<T>): Promise<T | undefined> {
    try {
      return await asked;
    } catch (error) {
      if (!(error instanceof RefusedError)) throw error;
      this.app.toast(error.message, "fault");
      return undefined;
    }
  }

  private beginOnce(): void {
    // The properties of an element may be set after it has come into the page.
    if (this.begun || !this.isConnected || !(this.app as AppContext | undefined)) return;
    this.begun = true;
    this.begin();
  }
}
