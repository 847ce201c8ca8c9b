/** Planned ways, goals and prediction circles, contacts that fade, and what panels have drawn. */

import type { LiveMessage } from "../net/live";
import type { Point } from "../net/types";
import type { Line, Segments } from "../state/overlays";
import type { Scheme } from "../state/scheme";
import type { MapView } from "./views";

export interface LayersMessage extends LiveMessage {
  ways?: Readonly<Record<string, readonly Point[]>>;
  goals?: Readonly<Record<string, Point>>;
  circles?: Readonly<
    Record<string, readonly (readonly [x: number, y: number, z: number, r: number, t: number])[]>
  >;
}

export interface ContactsMessage extends LiveMessage {
  pairs: readonly (readonly [
    x: number,
    y: number,
    z: number,
    actor: unknown,
    other: unknown,
    kind: string,
  ])[];
}

const CONTACT_S = 60;
const MOST_CONTACTS = 500;
/** Alphas are rounded to such a part, so that all marks of one are drawn at once. */
const FADES = 10;
/** Predictions beyond this many seconds are no darker. */
const FAR_S = 4;

/** Contacts of the last minute. */
export class Contacts {
  private marks: { at: Point; withPerson: boolean; timeS: number }[] = [];

  hear(message: ContactsMessage, nowS: number): void {
    for (const [x, y, z, , , kind] of message.pairs) {
      this.marks.push({ at: [x, y, z], withPerson: kind === "person", timeS: nowS });
    }
    this.marks = this.marks.slice(-MOST_CONTACTS);
  }

  draw(pen: CanvasRenderingContext2D, view: MapView, nowS: number, scheme: Scheme): void {
    this.marks = this.marks.filter(({ timeS }) => nowS - timeS < CONTACT_S);
    pen.lineWidth = 2;
    for (const withPerson of [false, true]) {
      pen.strokeStyle = scheme.colour(withPerson ? "fault" : "warn");
      const marks = this.marks.filter((mark) => mark.withPerson === withPerson);
      strokeByAlpha(
        pen,
        marks,
        ({ timeS }) => 1 - (nowS - timeS) / CONTACT_S,
        ({ at }) => {
          const storey = view.storeyOf(at[2]);
          if (!view.isShown(storey)) return;
          const [x, y] = view.toCanvas(at[0], at[1], storey);
          pen.moveTo(x - 5, y - 5);
          pen.lineTo(x + 5, y + 5);
          pen.moveTo(x + 5, y - 5);
          pen.lineTo(x - 5, y + 5);
        },
      );
    }
  }
}

export function drawLayers(
  pen: CanvasRenderingContext2D,
  view: MapView,
  { ways, goals, circles }: LayersMessage,
  scheme: Scheme,
): void {
  const colour = scheme.colour("actor");
  for (const points of Object.values(ways ?? {})) {
    drawLine(pen, view, { points, colour, widthPx: 1.5 });
  }
  pen.strokeStyle = colour;
  pen.lineWidth = 1.5;
  for (const [x, y, z] of Object.values(goals ?? {})) {
    const storey = view.storeyOf(z);
    if (!view.isShown(storey)) continue;
    const [px, py] = view.toCanvas(x, y, storey);
    pen.strokeRect(px - 4, py - 4, 8, 8);
  }
  pen.strokeStyle = scheme.colour("fault");
  pen.lineWidth = 1;
  strokeByAlpha(
    pen,
    Object.values(circles ?? {}).flat(),
    ([, , , , aheadS]) => 0.7 - 0.5 * Math.min(1, aheadS / FAR_S),
    ([x, y, z, radius]) => {
      const storey = view.storeyOf(z);
      if (!view.isShown(storey)) return;
      const [px, py] = view.toCanvas(x, y, storey);
      pen.moveTo(px + radius * view.scale, py);
      pen.arc(px, py, radius * view.scale, 0, 2 * Math.PI);
    },
  );
}

/** Stroke marks that are traced one by one; those that are about as dark become one path. */
function strokeByAlpha<Mark>(
  pen: CanvasRenderingContext2D,
  marks: readonly Mark[],
  alphaOf: (mark: Mark) => number,
  trace: (mark: Mark) => void,
): void {
  const alike = new Map<number, Mark[]>();
  for (const mark of marks) {
    const step = Math.ceil(FADES * alphaOf(mark));
    const same = alike.get(step);
    if (same) same.push(mark);
    else alike.set(step, [mark]);
  }
  for (const [step, same] of alike) {
    pen.globalAlpha = Math.max(0, Math.min(1, step / FADES));
    pen.beginPath();
    same.forEach(trace);
    pen.stroke();
  }
  pen.globalAlpha = 1;
}

/** A line over the map; where it changes the storey it is broken. */
export function drawLine(pen: CanvasRenderingContext2D, view: MapView, line: Line): void {
  pen.strokeStyle = pen.fillStyle = line.colour;
  pen.lineWidth = line.widthPx;
  pen.setLineDash(line.dashed ? [5, 4] : []);
  pen.beginPath();
  let before: number | null = null;
  for (const [x, y, z] of line.points) {
    const storey = view.storeyOf(z);
    if (!view.isShown(storey)) {
      before = null;
      continue;
    }
    const at = view.toCanvas(x, y, storey);
    if (storey === before) pen.lineTo(...at);
    else pen.moveTo(...at);
    before = storey;
  }
  if (line.closed) pen.closePath();
  if (line.filled) {
    pen.globalAlpha = 0.2;
    pen.fill();
    pen.globalAlpha = 1;
  }
  pen.stroke();
  pen.setLineDash([]);
}

export function drawSegments(
  pen: CanvasRenderingContext2D,
  view: MapView,
  { pairs, colour }: Segments,
): void {
  pen.strokeStyle = colour;
  pen.lineWidth = 1;
  pen.beginPath();
  for (const [from, to] of pairs) {
    const storey = view.storeyOf(from[2]);
    if (!view.isShown(storey) || view.storeyOf(to[2]) !== storey) continue;
    pen.moveTo(...view.toCanvas(from[0], from[1], storey));
    pen.lineTo(...view.toCanvas(to[0], to[1], storey));
  }
  pen.stroke();
}

export function drawMarks(
  pen: CanvasRenderingContext2D,
  view: MapView,
  points: readonly Point[],
  colour: string,
): void {
  pen.fillStyle = colour;
  for (const [x, y, z] of points) {
    const storey = view.storeyOf(z);
    if (!view.isShown(storey)) continue;
    const [px, py] = view.toCanvas(x, y, storey);
    pen.fillRect(px - 4, py - 4, 8, 8);
  }
}
