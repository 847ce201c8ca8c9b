/** The wishes in the page's address behind its #, which is in no request and no server's log. */

import type { Admission } from "../net/messages";
import type { Place } from "../render/picking";

export interface AddressWish {
  /** The operator key; null for people without one. */
  operator: string | null;
  /** The name of the zone that the link was made in, of which there may be copies. */
  zone: string | null;
  /** A place to look at and to be asked to walk to. */
  at: Place | null;
  /** The name of somebody to be asked to follow. */
  follow: string | null;
  /** The direction of the first view, radians from +x; null for where people are seen. */
  lookYaw: number | null;
  /** The operator's pass or the invitation that lets this person in. */
  admission: Admission | null;
  /** The part that may stay in the address: everything that is not secret. */
  rest: string;
}

const SECRETS = ["operator=", "pass=", "invitation="];

/** Read `#operator=KEY&zone=NAME&at=x,y,z&look=90&follow=NAME`, with `pass=` or `invitation=`; z may be left out. */
export function readAddress(hash: string): AddressWish {
  const parts = hash.replace(/^#/, "").split("&");
  const rest = parts.filter(
    (part) => part !== "" && !SECRETS.some((secret) => part.startsWith(secret)),
  );
  const wishes = new URLSearchParams(hash.slice(1));
  return {
    operator: wishes.get("operator"),
    admission: readAdmission(wishes),
    zone: readZone(wishes.get("zone")),
    at: readPlace(wishes.get("at")),
    follow: readName(wishes.get("follow")),
    lookYaw: readDirection(wishes.get("look")),
    rest: rest.length > 0 ? `#${rest.join("&")}` : "",
  };
}

function readAdmission(wishes: URLSearchParams): Admission | null {
  for (const way of ["pass", "invitation"] as const) {
    const secret = wishes.get(way);
    if (secret !== null && secret !== "" && secret.length <= 256) return { way, secret };
  }
  return null;
}

function readPlace(text: string | null): Place | null {
  const numbers = (text ?? "").split(",").map((part) => (part.trim() === "" ? NaN : Number(part)));
  const [x = NaN, y = NaN, z = 0] = numbers;
  const fits = numbers.length <= 3 && [x, y, z].every((metres) => Math.abs(metres) <= 100_000);
  return fits ? { x, y, z } : null;
}

function readZone(text: string | null): string | null {
  return text !== null && /^[a-z0-9-]{1,32}$/.test(text) ? text : null;
}

function readName(text: string | null): string | null {
  const name = text?.trim() ?? "";
  return name === "" ? null : name;
}

/**
 * A link to a place, and to what one sees from there: the page's address without any secret. It
 * names the zone where that is a copy.
 */
export function linkToPlace(
  page: string,
  { x, y, z }: Place,
  yaw: number,
  zone: string | null = null,
): string {
  const place = [x, y, z].map((metres) => Number(metres.toFixed(1))).join(",");
  const degrees = Math.round((Math.atan2(Math.sin(yaw), Math.cos(yaw)) * 180) / Math.PI);
  return `${bare(page)}#${zoneOf(zone)}at=${place}&look=${degrees}`;
}

/** A link that asks whether to follow somebody, who may be in a copy of a zone. */
export function linkToPerson(page: string, name: string, zone: string | null = null): string {
  return `${bare(page)}#${zoneOf(zone)}follow=${encodeURIComponent(name)}`;
}

function zoneOf(zone: string | null): string {
  return zone === null ? "" : `zone=${zone}&`;
}

function bare(page: string): string {
  return page.split("#")[0] ?? "";
}

/** A direction in degrees, 0 to the east and 90 to the north. */
function readDirection(text: string | null): number | null {
  const degrees = text === null || text.trim() === "" ? NaN : Number(text);
  return Math.abs(degrees) <= 360 ? (degrees * Math.PI) / 180 : null;
}
