/** Draws avatars with heading and tag; many at once, by colour. */

import { reasonColour, reasonName, reasonText } from "../state/reasons";
import type { Scheme } from "../state/scheme";
import { type Avatar, type Place, placeAt } from "./avatars";
import { type Box, spots } from "./labels";
import type { MapOptions } from "./options";
import type { MapView } from "./views";

const LEAST_RADIUS_PX = 3;
/** With more tags than this nobody could read one. */
const MOST_TAGS = 120;
const TURN = 2 * Math.PI;
const TAG_FONT = "11px system-ui, sans-serif";
/** Of more texts the widths are measured anew. */
const MOST_WIDTHS = 4096;

/** An avatar where it is drawn. */
export interface Drawn {
  avatar: Avatar;
  px: number;
  py: number;
  heading: number;
}

/** The widths of tags, which take longer to measure than to draw. */
const widths = new Map<string, number>();
const place: Place = { x: 0, y: 0, z: 0, heading: 0 };

/** Where everybody within the canvas is at a moment. */
export function placed(avatars: Iterable<Avatar>, view: MapView, timeS: number): Drawn[] {
  const found: Drawn[] = [];
  for (const avatar of avatars) {
    placeAt(avatar, timeS, place);
    const storey = view.storeyOf(place.z);
    if (!view.isShown(storey)) continue;
    const [px, py] = view.toCanvas(place.x, place.y, storey);
    if (px < -20 || py < -20 || px > view.width + 20 || py > view.height + 20) continue;
    found.push({ avatar, px, py, heading: place.heading });
  }
  return found;
}

export function colourOf({ kind, reason }: Avatar, scheme: Scheme): string {
  return kind === "person"
    ? scheme.colour("person")
    : reasonColour(reasonName(reason), scheme.dark);
}

export function drawPeople(
  pen: CanvasRenderingContext2D,
  view: MapView,
  drawn: readonly Drawn[],
  chosen: ReadonlySet<string>,
  scheme: Scheme,
): void {
  const byColour = new Map<string, Drawn[]>();
  for (const one of drawn) {
    const colour = colourOf(one.avatar, scheme);
    const same = byColour.get(colour);
    if (same) same.push(one);
    else byColour.set(colour, [one]);
  }
  for (const [colour, same] of byColour) {
    pen.fillStyle = pen.strokeStyle = colour;
    pen.beginPath();
    for (const { avatar, px, py } of same) {
      const radius = radiusPx(avatar, view);
      // People are round, actors are square.
      if (avatar.kind === "person") {
        pen.moveTo(px + radius, py);
        pen.arc(px, py, radius, 0, TURN);
      } else {
        pen.rect(px - radius, py - radius, 2 * radius, 2 * radius);
      }
    }
    pen.fill();
    pen.lineWidth = 1.5;
    pen.beginPath();
    for (const { avatar, px, py, heading } of same) {
      const length = radiusPx(avatar, view) + 5;
      pen.moveTo(px, py);
      pen.lineTo(px + Math.cos(heading) * length, py - Math.sin(heading) * length);
    }
    pen.stroke();
  }
  pen.strokeStyle = scheme.colour("focus");
  pen.lineWidth = 2.5;
  pen.beginPath();
  for (const { avatar, px, py } of drawn) {
    if (!chosen.has(avatar.key)) continue;
    const radius = radiusPx(avatar, view) + 5;
    pen.moveTo(px + radius, py);
    pen.arc(px, py, radius, 0, TURN);
  }
  pen.stroke();
}

export function drawTags(
  pen: CanvasRenderingContext2D,
  drawn: readonly Drawn[],
  chosen: ReadonlySet<string>,
  tags: MapOptions["tags"],
  scheme: Scheme,
  places: readonly Box[],
  { width, height }: MapView,
): void {
  if (tags === "none") return;
  // Those who are chosen get room first.
  const first = drawn.filter((one) => chosen.has(one.avatar.key));
  const rest = drawn.length <= MOST_TAGS ? drawn.filter((one) => !first.includes(one)) : [];
  pen.font = TAG_FONT;
  pen.textAlign = "left";
  pen.lineWidth = 3;
  pen.lineJoin = "round";
  pen.strokeStyle = scheme.colour("map-ground");
  pen.fillStyle = scheme.colour("ink");
  const told = [...first, ...rest]
    .slice(0, MOST_TAGS)
    .map(({ avatar, px, py }) => ({ text: tagOf(avatar, tags), x: px, y: py }))
    .filter(({ text }) => text !== "");
  const wishes = told.map(({ text, x, y }) => ({ x, y, width: widthOf(pen, text) }));
  for (const [index, spot] of spots(wishes, places, [0, 0, width, height]).entries()) {
    const text = told[index]?.text;
    if (!spot || text === undefined) continue;
    pen.strokeText(text, spot.x, spot.y);
    pen.fillText(text, spot.x, spot.y);
  }
}

function widthOf(pen: CanvasRenderingContext2D, text: string): number {
  let width = widths.get(text);
  if (width === undefined) {
    if (widths.size >= MOST_WIDTHS) widths.clear();
    width = pen.measureText(text).width;
    widths.set(text, width);
  }
  return width;
}

export function tagOf(avatar: Avatar, tags: MapOptions["tags"]): string {
  if (tags === "name") return avatar.name;
  if (tags === "group") return avatar.groups.join(", ");
  if (tags === "reason")
    return avatar.kind === "actor" ? reasonText(reasonName(avatar.reason)) : "";
  return "";
}

function radiusPx({ radiusM }: Avatar, view: MapView): number {
  return Math.max(LEAST_RADIUS_PX, radiusM * view.scale);
}
