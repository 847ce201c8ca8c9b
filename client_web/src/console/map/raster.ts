/** Values of cells as a picture: a heat map, or a slice of a risk field. */

import type { Raster } from "../net/types";

export interface Picture {
  canvas: HTMLCanvasElement;
  /** The value that has the full colour. */
  most: number;
}

/** The float32 values of a raster, row by row from the south. */
export function valuesOf({ values, width, height }: Raster): Float32Array {
  const bytes = Uint8Array.from(atob(values), (character) => character.charCodeAt(0));
  const count = Math.min(width * height, Math.floor(bytes.length / 4));
  const view = new DataView(bytes.buffer);
  return Float32Array.from({ length: width * height }, (_, index) =>
    index < count ? view.getFloat32(index * 4, true) : 0,
  );
}

/** A value that a hundredth of the cells with anything in them reach; zero where all are empty. */
export function fullValue(values: Float32Array): number {
  const some = values.filter((value) => Number.isFinite(value) && value > 0).sort();
  return some[Math.floor(0.99 * (some.length - 1))] ?? 0;
}

/** The colour of a part of the full value, from 0 to 1: yellow over red to violet. */
export function heatColour(part: number): readonly [number, number, number, number] {
  const p = Math.max(0, Math.min(1, part));
  const red = p < 0.6 ? 250 - 60 * p : 214 - 260 * (p - 0.6);
  const green = Math.max(20, 200 - 260 * p);
  const blue = 40 + 110 * p * p;
  return [Math.round(red), Math.round(green), Math.round(blue), Math.round(60 + 150 * p)];
}

export function pictureOf(raster: Raster, values: Float32Array, most: number): Picture {
  const canvas = document.createElement("canvas");
  canvas.width = raster.width;
  canvas.height = raster.height;
  const pen = canvas.getContext("2d");
  if (!pen) return { canvas, most };
  const image = pen.createImageData(raster.width, raster.height);
  for (let row = 0; row < raster.height; row++) {
    for (let column = 0; column < raster.width; column++) {
      const value = values[row * raster.width + column] ?? 0;
      if (!(value > 0) || most <= 0) continue;
      // Pictures begin in the north.
      const at = ((raster.height - 1 - row) * raster.width + column) * 4;
      image.data.set(heatColour(value / most), at);
    }
  }
  pen.putImageData(image, 0, 0);
  return { canvas, most };
}
