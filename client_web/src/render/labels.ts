/** Names and spoken lines above heads, as HTML: of the nearest avatars, as far as there is room. */

import { type PerspectiveCamera, Vector3 } from "three";
import { crown } from "../world/body";
import { hasSign } from "../world/guides";
import type { Avatar } from "../world/world";
import { LabelRoom } from "./labelroom";

const MOST = 24;
const FAR_M = 26;
const FADE_M = 8;
const ABOVE_M = 0.22;
/** Over a guide there is room for the lantern as well. */
const ABOVE_SIGN_M = 0.62;
const SPOKEN_MS = 7000;
/** A fainter label is not shown at all. */
const FAINT = 0.05;

/** A label that is shown keeps its room against those who are nearer by less than this. */
const KEEPS_M = 1.5;

interface Label {
  element: HTMLElement;
  name: HTMLElement;
  spoken: HTMLElement;
  spokenUntilMs: number;
  /** The word that says that its person is away; empty while they are there. */
  away: string;
  /** Pixels as it is shown now; null if it has to be measured anew. */
  size: { width: number; height: number } | null;
}

export class Labels {
  private readonly labels = new Map<number, Label>();
  private readonly room = new LabelRoom();
  private readonly at = new Vector3();

  /** `away` is called for the word that marks those who are away. */
  constructor(
    private readonly layer: HTMLElement,
    private readonly away: () => string,
  ) {}

  /** Show what somebody said above the head for a while. */
  say(avatar: Avatar, text: string): void {
    const label = this.labelOf(avatar);
    label.spoken.textContent = text.length > 90 ? `${text.slice(0, 88)}…` : text;
    label.spokenUntilMs = performance.now() + SPOKEN_MS;
    label.spoken.hidden = false;
    label.size = null;
  }

  /** `strength` says how plainly an avatar's label is to be seen, 0 to 1. */
  update(
    avatars: ReadonlyMap<number, Avatar>,
    camera: PerspectiveCamera,
    strength: (avatar: Avatar) => number,
  ): void {
    const { clientWidth: width, clientHeight: height } = this.layer;
    const now = performance.now();
    const nearest = [...avatars.values()]
      .map((avatar) => ({
        avatar,
        distanceM: camera.position.distanceTo(this.head(avatar)),
        plainly: strength(avatar),
      }))
      .filter(({ distanceM, plainly }) => distanceM < FAR_M && plainly > FAINT)
      .sort((a, b) => this.rank(a.avatar, a.distanceM, now) - this.rank(b.avatar, b.distanceM, now))
      .slice(0, MOST);
    const seen = new Set<number>();
    this.room.clear();
    for (const { avatar, distanceM, plainly } of nearest) {
      this.head(avatar).project(camera);
      if (this.at.z > 1 || Math.abs(this.at.x) > 1.1 || Math.abs(this.at.y) > 1.1) continue;
      const label = this.labelOf(avatar);
      markAway(label, avatar, avatar.away ? this.away() : "");
      const x = ((this.at.x + 1) / 2) * width;
      const y = ((1 - this.at.y) / 2) * height;
      if (!this.room.take({ x, y, ...this.sizeOf(label, now) })) continue;
      seen.add(avatar.id);
      const { element } = label;
      element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      const near = Math.min(1, (FAR_M - distanceM) / FADE_M);
      element.style.opacity = (near * plainly).toFixed(2);
    }
    for (const [id, { element }] of this.labels) {
      element.hidden = !seen.has(id);
      if (avatars.has(id)) continue;
      element.remove();
      this.labels.delete(id);
    }
  }

  /** Lower ranks choose their room first: who speaks, the own avatar, then by distance. */
  private rank({ id, own }: Avatar, distanceM: number, now: number): number {
    const label = this.labels.get(id);
    const speaks = label !== undefined && now < label.spokenUntilMs;
    const isShown = label?.element.hidden === false;
    return distanceM - (speaks ? 2 * FAR_M : 0) - (own ? FAR_M : 0) - (isShown ? KEEPS_M : 0);
  }

  /** The size of a label; measuring it shows it, so this is asked for labels in sight alone. */
  private sizeOf(label: Label, now: number): { width: number; height: number } {
    const { element, name, spoken } = label;
    if (!spoken.hidden && now > label.spokenUntilMs) {
      spoken.hidden = true;
      label.size = null;
    }
    if (label.size === null) {
      element.hidden = false;
      const width = Math.max(name.offsetWidth, spoken.offsetWidth);
      const top = spoken.hidden ? name.offsetTop : spoken.offsetTop;
      label.size = { width, height: name.offsetTop + name.offsetHeight - top };
    }
    return label.size;
  }

  /** The place of a label. */
  private head({ look, animator: { body, build } }: Avatar): Vector3 {
    crown(body, build, this.at);
    this.at.z += hasSign(look) ? ABOVE_SIGN_M : ABOVE_M;
    return this.at;
  }

  private labelOf(avatar: Avatar): Label {
    const known = this.labels.get(avatar.id);
    if (known) return known;
    const element = document.createElement("div");
    element.className = `label ${avatar.kind}${avatar.own ? " own" : ""}`;
    const spoken = document.createElement("span");
    spoken.className = "spoken";
    spoken.dir = "auto";
    spoken.hidden = true;
    const name = document.createElement("span");
    name.className = "name";
    name.append(called(avatar));
    element.append(spoken, name);
    this.layer.append(element);
    const label = { element, name, spoken, spokenUntilMs: 0, away: "", size: null };
    this.labels.set(avatar.id, label);
    return label;
  }
}

function markAway(label: Label, avatar: Avatar, away: string): void {
  if (label.away === away) return;
  label.away = away;
  label.name.replaceChildren(called(avatar), away === "" ? "" : ` · ${away}`);
  label.element.classList.toggle("away", avatar.away);
  label.size = null;
}

/** A name in the direction of its own script. */
function called({ name }: Avatar): HTMLElement {
  const element = document.createElement("bdi");
  element.textContent = name;
  return element;
}
