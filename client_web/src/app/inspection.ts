/** `window.esplanade`: the page's state, read-only, for tests and the curious. See docs/client.md. */

import type { ConnectionState } from "../net/connection";
import type { Doors, Plan } from "../net/messages";
import type { Foot } from "../world/body";
import type { Avatar } from "../world/world";
import type { Session } from "./session";
import type { Picture } from "./picture";

export interface Inspection {
  readonly phase: ConnectionState["phase"];
  readonly id: number | null;
  readonly avatars: readonly Seen[];
  readonly doors: Readonly<Doors> | null;
  readonly plan: Plan | null;
  readonly chosenId: number | null;
  /** Direction in which the camera looks on the ground, radians from +x. */
  readonly cameraYaw: number;
  /** Frames drawn since the page was loaded. */
  readonly frames: number;
  readonly qualityLevel: number;
  /** Script time a frame, milliseconds: moving everybody, and placing the parts of their figures. */
  readonly scriptMs: { readonly moving: number; readonly figures: number };
  readonly delayS: number | null;
  readonly ownDelayS: number | null;
  readonly correctionM: number | null;
}

/** An avatar as it is drawn, with the feet it walks on. */
interface Seen extends Omit<Avatar, "animator"> {
  readonly feet: { readonly left: Foot; readonly right: Foot };
  /** The foot that its step stands on, and the tick at which it began; null without steps. */
  readonly step: { readonly stands: "left" | "right"; readonly tick: number } | null;
  /** Whether it points at something. */
  readonly pointing: boolean;
  /** Whether it makes a gesture. */
  readonly gesturing: boolean;
}

function seen({ id, kind, name, radius, look, own, pose, away, animator }: Avatar): Seen {
  const { left, right } = animator.body;
  const pointing = animator.pointing.target !== null;
  const drawn = animator.planted ? animator.step : null;
  const step = drawn && {
    stands: drawn.rightStands ? ("right" as const) : ("left" as const),
    tick: drawn.tick,
  };
  const feet = { left: left.foot, right: right.foot };
  const gesturing = animator.gesturing.active;
  return { id, kind, name, radius, look, own, pose, away, feet, step, pointing, gesturing };
}

declare global {
  interface Window {
    esplanade?: Inspection;
  }
}

export function offerInspection(session: Session, view: Picture): void {
  window.esplanade = Object.freeze({
    get phase() {
      return session.connection.state.phase;
    },
    get id() {
      return session.world?.ownId ?? null;
    },
    get avatars() {
      return structuredClone([...(session.world?.avatars.values() ?? [])].map(seen));
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
    get cameraYaw() {
      return view.camera.yaw;
    },
    get frames() {
      return session.frames;
    },
    get qualityLevel() {
      return view.qualityLevel;
    },
    get scriptMs() {
      return { moving: session.moving.ms, figures: view.placing.ms };
    },
    get delayS() {
      return session.world?.delayS ?? null;
    },
    get ownDelayS() {
      return session.world?.ownDelayS ?? null;
    },
    get correctionM() {
      return session.world?.correctionM ?? null;
    },
  });
}
