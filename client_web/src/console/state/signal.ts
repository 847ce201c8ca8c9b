/** A value that tells those who watch it when it has become another. */

import type { ReactiveController, ReactiveControllerHost } from "lit";

export type Stop = () => void;

/** A signal of any kind, for those who only want to know that it has changed. */
export interface Watchable {
  watch(tell: () => void): Stop;
}

export class Signal<T> implements Watchable {
  private readonly watchers = new Set<(value: T) => void>();

  constructor(private held: T) {}

  get value(): T {
    return this.held;
  }

  /** The same value again tells nobody. */
  set value(next: T) {
    if (Object.is(next, this.held)) return;
    this.held = next;
    for (const tell of [...this.watchers]) tell(next);
  }

  /** Call `tell` with each further value, until what is returned is called. */
  watch(tell: (value: T) => void): Stop {
    this.watchers.add(tell);
    return () => this.watchers.delete(tell);
  }
}

/** Draws an element anew whenever one of the signals changes, as long as it is in the page. */
export class Watching implements ReactiveController {
  private stops: Stop[] = [];

  constructor(
    private readonly host: ReactiveControllerHost,
    private readonly signals: () => readonly Watchable[],
  ) {
    host.addController(this);
  }

  hostConnected(): void {
    this.stops = this.signals().map((signal) =>
      signal.watch(() => {
        this.host.requestUpdate();
      }),
    );
  }

  hostDisconnected(): void {
    for (const stop of this.stops) stop();
    this.stops = [];
  }
}
