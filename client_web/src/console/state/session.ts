/** The operator who is logged in, and what happens when a session ends. */

import type { Api } from "../net/api";
import { RefusedError } from "../net/api";
import type { Me } from "../net/types";
import { Signal } from "./signal";
import type { State } from "./state";

/**
 * `away` means that the session of somebody who was in has ended: the page stays as it is, with
 * all that was typed, and asks again.
 */
export type Standing = "asking" | "unreachable" | "out" | "first" | "in" | "away";

export class Session {
  readonly standing = new Signal<Standing>("asking");
  /** Whether the world has no account yet. */
  readonly untouched = new Signal(false);
  private returning: { back: Promise<boolean>; settle: (same: boolean) => void } | null = null;

  constructor(
    private readonly api: Api,
    private readonly state: State,
    private firstToken: string | null = null,
  ) {
    api.comeBack = () => this.comeBack();
  }

  /** Find out who is logged in already. */
  async begin(): Promise<void> {
    if (this.firstToken !== null) {
      this.standing.value = "first";
      return;
    }
    try {
      this.enter(await this.api.once<Me>("GET", "/me"));
    } catch (error) {
      if (!(error instanceof RefusedError)) throw error;
      this.untouched.value = error.faults[0]?.arguments?.["first"] === true;
      this.standing.value = error.status === 401 ? "out" : "unreachable";
    }
  }

  async logIn(name: string, password: string): Promise<void> {
    this.enter(await this.api.once<Me>("POST", "/login", { name, password }));
  }

  /** Make the first account of a world with the one-time link of its log. */
  async makeFirst(name: string, password: string): Promise<void> {
    const token = this.firstToken;
    this.enter(await this.api.once<Me>("POST", "/first", { token, name, password }));
    this.firstToken = null;
  }

  /** Go from the form of the one-time link to the one of the password. */
  async dropFirst(): Promise<void> {
    this.firstToken = null;
    await this.begin();
  }

  async logOut(): Promise<void> {
    try {
      await this.api.once("POST", "/logout");
    } catch (error) {
      // A session that has ended by itself needs no end; one that goes on must be told.
      if (!(error instanceof RefusedError) || error.status !== 401) throw error;
    }
    this.leave();
  }

  /** Ask for a login; true once the same account is back. */
  comeBack(): Promise<boolean> {
    if (this.standing.value !== "in" && this.standing.value !== "away")
      return Promise.resolve(false);
    if (!this.returning) {
      let settle: (same: boolean) => void = () => undefined;
      const back = new Promise<boolean>((resolve) => (settle = resolve));
      this.returning = { back, settle };
      this.standing.value = "away";
    }
    return this.returning.back;
  }

  /** Whether the session still holds; asks for a login where it has ended. */
  async holds(): Promise<boolean> {
    try {
      this.state.me.value = await this.api.once<Me>("GET", "/me");
      return true;
    } catch (error) {
      if (!(error instanceof RefusedError)) throw error;
      return error.status === 401 ? await this.comeBack() : false;
    }
  }

  private enter(me: Me): void {
    const same = this.state.me.value?.account === me.account;
    this.state.me.value = me;
    this.standing.value = "in";
    this.returning?.settle(same);
    this.returning = null;
  }

  private leave(): void {
    this.returning?.settle(false);
    this.returning = null;
    this.standing.value = "out";
    this.state.me.value = null;
    this.state.chosen.value = [];
    this.state.draft.value = null;
  }
}
