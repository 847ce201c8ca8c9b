/** Names and spoken lines above heads, as HTML, for the nearest avatars only. */

import { type PerspectiveCamera, Vector3 } from "three";
import { crown } from "../world/body";
import type { Avatar } from "../world/world";

const MOST = 24;
const FAR_M = 26;
const FADE_M = 8;
const ABOVE_M = 0.22;
const SPOKEN_MS = 7000;
/** A fainter label is not shown at all. */
const FAINT = 0.05;

interface Label {
  element: HTMLElement;
  spoken: HTMLElement;
  spokenUntilMs: number;
}

export class Labels {
  private readonly labels = new Map<number, Label>();
  private readonly at = new Vector3();

  constructor(private readonly layer: HTMLElement) {}

  /** Show what somebody said above the head for a while. */
  say(avatar: Avatar, text: string): void {
    const label = this.labelOf(avatar);
    label.spoken.textContent = text.length > 90 ? `${text.slice(0, 88)}…` : text;
    label.spokenUntilMs = performance.now() + SPOKEN_MS;
  }

  /** `strength` says how plainly an avatar's label is to be seen, 0 to 1. */
  update(
    avatars: ReadonlyMap<number, Avatar>,
    camera: PerspectiveCamera,
    strength: (avatar: Avatar) => number,
  ): void {
    const { clientWidth: width, clientHeight: height } = this.layer;
    const nearest = [...avatars.values()]
      .map((avatar) => ({
        avatar,
        distanceM: camera.position.distanceTo(this.head(avatar)),
        plainly: strength(avatar),
      }))
      .filter(({ distanceM, plainly }) => distanceM < FAR_M && plainly > FAINT)
      .sort((a, b) => a.distanceM - b.distanceM)
      .slice(0, MOST);
    const seen = new Set<number>();
    for (const { avatar, distanceM, plainly } of nearest) {
      this.head(avatar).project(camera);
      if (this.at.z > 1 || Math.abs(this.at.x) > 1.1 || Math.abs(this.at.y) > 1.1) continue;
      seen.add(avatar.id);
      const { element, spoken, spokenUntilMs } = this.labelOf(avatar);
      const x = ((this.at.x + 1) / 2) * width;
      const y = ((1 - this.at.y) / 2) * height;
      element.hidden = false;
      element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      const near = Math.min(1, (FAR_M - distanceM) / FADE_M);
      element.style.opacity = (near * plainly).toFixed(2);
      element.style.zIndex = String(1000 - Math.round(distanceM * 10));
      spoken.hidden = performance.now() > spokenUntilMs;
    }
    for (const [id, { element }] of this.labels) {
      if (!avatars.has(id)) {
        element.remove();
        this.labels.delete(id);
      } else if (!seen.has(id)) element.hidden = true;
    }
  }

  /** The place of a label. */
  private head({ animator: { body, build } }: Avatar): Vector3 {
    crown(body, build, this.at);
    this.at.z += ABOVE_M;
    return this.at;
  }

  private labelOf(avatar: Avatar): Label {
    const known = this.labels.get(avatar.id);
    if (known) return known;
    const element = document.createElement("div");
    element.className = `label ${avatar.kind}${avatar.own ? " own" : ""}`;
    const spoken = document.createElement("span");
    spoken.className = "spoken";
    spoken.hidden = true;
    const name = document.createElement("span");
    name.className = "name";
    name.textContent = avatar.name;
    element.append(spoken, name);
    this.layer.append(element);
    const label = { element, spoken, spokenUntilMs: 0 };
    this.labels.set(avatar.id, label);
    return label;
  }
}
