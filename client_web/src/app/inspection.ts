/** `window.esplanade`: what the page knows, read-only, for tests and curious people. See docs/client.md. */

import type { ConnectionState } from "../net/connection";
import type { Doors, Plan } from "../net/messages";
import type { Avatar } from "../world/world";
import type { Session } from "./session";
import type { View } from "./view";

export interface Inspection {
  readonly phase: ConnectionState["phase"];
  readonly id: number | null;
  readonly avatars: readonly Readonly<Avatar>[];
  readonly doors: Readonly<Doors> | null;
  readonly plan: Plan | null;
  readonly chosenId: number | null;
  /** Frames drawn since the page was loaded. */
  readonly frames: number;
  readonly qualityLevel: number;
  readonly delayS: number | null;
  readonly correctionM: number | null;
}

declare global {
  interface Window {
    esplanade?: Inspection;
  }
}

export function offerInspection(session: Session, view: View): void {
  window.esplanade = Object.freeze({
    get phase() {
      return session.connection.state.phase;
    },
    get id() {
      return session.world?.ownId ?? null;
    },
    get avatars() {
      return structuredClone(
        [...(session.world?.avatars.values() ?? [])].map(
          ({ id, kind, name, radius, own, pose }) => ({
            id,
            kind,
            name,
            radius,
            own,
            pose,
          }),
        ),
      );
    },
    get doors() {
      return structuredClone(session.world?.doors ?? null);
    },
    get plan() {
      return structuredClone(session.world?.plan ?? null);
    },
    get chosenId() {
      return session.chosenId;
    },
    get frames() {
      return session.frames;
    },
    get qualityLevel() {
      return view.qualityLevel;
    },
    get delayS() {
      return session.world?.delayS ?? null;
    },
    get correctionM() {
      return session.world?.correctionM ?? null;
    },
  });
}
