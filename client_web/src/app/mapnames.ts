/** Names, and what was said, beside the marks of a map, as far as there is room. */

import { isolated, name as named } from "../language/phrase";
import { words } from "../language/words";
import { LabelRoom } from "../render/labelroom";
import type { Avatar } from "../world/world";

const SPOKEN_MS = 7000;
const MOST_CHARS = 60;
const FONT_PX = 12.5;
const ABOVE_PX = 12;
const PADDING_PX = 5;
const COLORS = {
  person: ["rgb(250 247 241 / 88%)", "#22262b"],
  actor: ["rgb(11 116 108 / 85%)", "#ffffff"],
  own: ["#ffd678", "#22262b"],
  spoken: ["#ffffff", "#22262b"],
} as const;

export class MapNames {
  private readonly room = new LabelRoom();
  private readonly said = new Map<number, { text: string; untilMs: number }>();

  /** Show what somebody said for a while. */
  say(id: number, text: string): void {
    const short = text.length > MOST_CHARS ? `${text.slice(0, MOST_CHARS - 1)}…` : text;
    this.said.set(id, { text: short, untilMs: performance.now() + SPOKEN_MS });
  }

  /** The names of those who are given; who speaks, the own avatar and the nearest come first. */
  draw(
    pen: CanvasRenderingContext2D,
    pixel: number,
    avatars: readonly Avatar[],
    own: Avatar,
    at: (avatar: Avatar) => [number, number],
  ): void {
    const now = performance.now();
    for (const [id, { untilMs }] of this.said) if (untilMs < now) this.said.delete(id);
    const apartM = ({ pose }: Avatar): number =>
      Math.hypot(pose.x - own.pose.x, pose.y - own.pose.y);
    const first = ({ id }: Avatar): number => (this.said.has(id) ? 0 : 1);
    const sorted = [...avatars].sort((a, b) => first(a) - first(b) || apartM(a) - apartM(b));
    this.room.clear();
    pen.font = `600 ${FONT_PX * pixel}px system-ui, sans-serif`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    for (const avatar of sorted) {
      const said = this.said.get(avatar.id);
      const text = isolated(
        said
          ? [named(avatar.name), ": ", named(said.text)]
          : [named(avatar.name), avatar.away ? ` · ${words.people.away}` : ""],
      );
      const [x, y] = at(avatar);
      const width = pen.measureText(text).width + 2 * PADDING_PX * pixel;
      const box = { x, y: y - ABOVE_PX * pixel, width, height: (FONT_PX + 6) * pixel };
      if (!this.room.take(box)) continue;
      const [paper, ink] = COLORS[said ? "spoken" : avatar.own ? "own" : avatar.kind];
      pen.fillStyle = paper;
      pen.beginPath();
      pen.roundRect(x - width / 2, box.y - box.height, width, box.height, 6 * pixel);
      pen.fill();
      pen.fillStyle = ink;
      pen.fillText(text, x, box.y - box.height / 2);
    }
  }
}
