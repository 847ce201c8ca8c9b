/** The interface for operators over HTTP: what is refused comes as faults. */

import type { Answer, Command, Fault } from "./types";

const NO_ANSWER = "the server does not answer; is it running?";

/** A request that was refused, or that got no answer (status 0). */
export class RefusedError extends Error {
  constructor(
    readonly status: number,
    readonly faults: readonly Fault[],
  ) {
    super(faults.map((fault) => fault.text).join("; "));
    this.name = "RefusedError";
  }

  get code(): string {
    return this.faults[0]?.code ?? "unknown";
  }
}

export type Query = Readonly<Record<string, string | number | boolean | null | undefined>>;

export class Api {
  /**
   * Called when a session has ended while something was asked. Resolves to true once the same
   * account is back, so that the request is sent again; false lets it be refused.
   */
  comeBack: () => Promise<boolean> = () => Promise.resolve(false);

  constructor(
    /** The address of the interface, which ends with /api/v1, or with a zone behind that. */
    readonly base: string,
    private readonly fetch: typeof globalThis.fetch = (...given) => globalThis.fetch(...given),
  ) {}

  get<T>(path: string, query: Query = {}, signal?: AbortSignal): Promise<T> {
    return this.ask<T>("GET", path + queryText(query), undefined, signal);
  }

  /** A request that changes something. */
  send<T>(method: "POST" | "PATCH" | "PUT" | "DELETE", path: string, body?: unknown): Promise<T> {
    return this.ask<T>(method, path, body);
  }

  command(command: Command, signal?: AbortSignal): Promise<Answer> {
    return this.ask<Answer>("POST", "/commands", command, signal);
  }

  /** Several commands in one tick: all of them, or none. */
  commands(commands: readonly Command[]): Promise<Answer[]> {
    return this.ask<Answer[]>("POST", "/commands", commands);
  }

  /** A request that may be refused for want of a session without anybody being asked to log in. */
  async once<T>(method: string, path: string, body?: unknown, signal?: AbortSignal): Promise<T> {
    const headers: Record<string, string> = { Accept: "application/json" };
    if (method !== "GET") headers["X-Esplanade"] = "1";
    if (body !== undefined) headers["Content-Type"] = "application/json";
    let response: Response;
    try {
      response = await this.fetch(this.base + path, {
        method,
        headers,
        credentials: "same-origin",
        cache: "no-store",
        ...(body === undefined ? {} : { body: JSON.stringify(body) }),
        ...(signal ? { signal } : {}),
      });
    } catch (error) {
      if (signal?.aborted) throw error;
      throw new RefusedError(0, [{ code: "no_answer", text: NO_ANSWER }]);
    }
    const text = await response.text();
    if (response.ok) return (text === "" ? undefined : JSON.parse(text)) as T;
    throw new RefusedError(response.status, faultsOf(response.status, text));
  }

  private async ask<T>(
    method: string,
    path: string,
    body?: unknown,
    signal?: AbortSignal,
  ): Promise<T> {
    try {
      return await this.once<T>(method, path, body, signal);
    } catch (error) {
      const ended = error instanceof RefusedError && error.status === 401;
      if (!ended || !(await this.comeBack())) throw error;
      return await this.once<T>(method, path, body, signal);
    }
  }
}

function queryText(query: Query): string {
  const parameters = new URLSearchParams();
  for (const [name, value] of Object.entries(query)) {
    if (value !== null && value !== undefined) parameters.set(name, String(value));
  }
  const text = parameters.toString();
  return text && `?${text}`;
}

/** The faults of a refusal; something between us and the server may have answered otherwise. */
function faultsOf(status: number, text: string): readonly Fault[] {
  try {
    const { faults } = JSON.parse(text) as { faults?: unknown };
    if (Array.isArray(faults) && faults.length > 0) return faults as Fault[];
  } catch {
    // No JSON: below it is told by its status.
  }
  return [{ code: "refused", text: `the server refused this (status ${status})` }];
}
