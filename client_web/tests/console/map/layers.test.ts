import { describe, expect, it } from "vitest";
import { Contacts, drawLayers } from "../../../src/console/map/layers";
import { MapView } from "../../../src/console/map/views";
import type { Scheme } from "../../../src/console/state/scheme";

const scheme = { dark: false, colour: (name: string) => name } as unknown as Scheme;

/** A pen that notes what it strokes: colour, alpha, and how many pieces the path has. */
class Pen {
  strokeStyle = "";
  globalAlpha = 1;
  readonly strokes: [string, number, number][] = [];
  private pieces = 0;

  beginPath(): void {
    this.pieces = 0;
  }
  moveTo(): void {
    this.pieces++;
  }
  stroke(): void {
    this.strokes.push([this.strokeStyle, this.globalAlpha, this.pieces]);
  }
  lineTo(): void {}
  arc(): void {}
  strokeRect(): void {}
  setLineDash(): void {}
}

function view(): MapView {
  const made = new MapView();
  made.setWorld([0, 0, 40, 20], [0, 4]);
  return made;
}

describe("marks of the map", () => {
  it("are drawn at once where they are about as dark", () => {
    const pen = new Pen();
    const circles = Array.from({ length: 40 }, (_, k) => [k, 1, 0, 0.5, (k % 4) + 1] as const);
    drawLayers(
      pen as unknown as CanvasRenderingContext2D,
      view(),
      { channel: "", circles: { "": circles } },
      scheme,
    );
    expect(pen.strokes).toEqual([
      ["fault", 0.6, 10],
      ["fault", 0.5, 10],
      ["fault", 0.4, 10],
      ["fault", 0.2, 10],
    ]);
    expect(pen.globalAlpha).toBe(1);
  });

  it("fade, and those of storeys that are not shown are left out", () => {
    const contacts = new Contacts();
    const pairs = [0, 1, 2, 3].map((k) => [k, 1, k === 3 ? 4 : 0, "", "", "person"] as const);
    contacts.hear({ channel: "", pairs }, 0);
    contacts.hear({ channel: "", pairs: [[5, 5, 0, "", "", "actor"]] }, 30);
    const pen = new Pen();
    const ground = view();
    ground.only = 0;
    contacts.draw(pen as unknown as CanvasRenderingContext2D, ground, 30, scheme);
    expect(pen.strokes).toEqual([
      ["warn", 1, 2],
      ["fault", 0.5, 6],
    ]);
    contacts.draw(pen as unknown as CanvasRenderingContext2D, ground, 61, scheme);
    expect(pen.strokes.slice(2)).toEqual([["warn", 0.5, 2]]);
  });
});
