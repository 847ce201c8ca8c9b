/** Patterns painted on small canvases: the bays of a façade, slabs of paving, boards of wood. */

import { CanvasTexture, RepeatWrapping, SRGBColorSpace } from "three";

/** One bay of one floor: a window with frame, glass and sill, to be tinted by the wall's colour. */
export function facadeTexture(): CanvasTexture {
  return pattern(128, (pen, size) => {
    pen.fillStyle = "#ffffff";
    pen.fillRect(0, 0, size, size);
    pen.fillStyle = "#e9e6e0";
    pen.fillRect(0, 0, size, 5);
    const [x, y, w, h] = [36, 30, 56, 68];
    pen.fillStyle = "#f7f4ee";
    pen.fillRect(x - 6, y - 6, w + 12, h + 12);
    const glass = pen.createLinearGradient(0, y, 0, y + h);
    glass.addColorStop(0, "#7f9db3");
    glass.addColorStop(1, "#43586a");
    pen.fillStyle = glass;
    pen.fillRect(x, y, w, h);
    pen.fillStyle = "#f7f4ee";
    pen.fillRect(x + w / 2 - 2, y, 4, h);
    pen.fillRect(x, y + h / 3, w, 4);
    pen.fillStyle = "#bdb6aa";
    pen.fillRect(x - 10, y + h + 4, w + 20, 6);
  });
}

/** Four slabs that differ a little, with joints. */
export function pavingTexture(): CanvasTexture {
  return pattern(128, (pen, size) => {
    const half = size / 2;
    const shades = ["#ffffff", "#f1efeb", "#f6f4f0", "#fbfaf7"];
    shades.forEach((shade, i) => {
      pen.fillStyle = shade;
      pen.fillRect((i % 2) * half, Math.floor(i / 2) * half, half, half);
    });
    pen.strokeStyle = "#d5d0c6";
    pen.lineWidth = 2;
    for (const at of [0, half]) {
      pen.strokeRect(at, -2, half, size + 4);
      pen.strokeRect(-2, at, size + 4, half);
    }
  });
}

/** Boards of wood, each row shifted by half a board. */
export function boardsTexture(): CanvasTexture {
  return pattern(256, (pen, size) => {
    const rows = 8;
    const shades = ["#ffffff", "#f3ece2", "#f9f3ea", "#ece3d6", "#f6efe5"];
    const tall = size / rows;
    for (let row = 0; row < rows; row++) {
      for (let half = 0; half < 3; half++) {
        const x = (half - (row % 2) / 2) * (size / 2);
        pen.fillStyle = shades[(row * 3 + half * 2) % shades.length] ?? "#ffffff";
        pen.fillRect(x, row * tall, size / 2, tall);
        pen.fillStyle = "#cdbfa9";
        pen.fillRect(x, row * tall, 2, tall);
      }
      pen.fillStyle = "#cdbfa9";
      pen.fillRect(0, row * tall, size, 1.5);
    }
  });
}

function pattern(
  size: number,
  paint: (pen: CanvasRenderingContext2D, size: number) => void,
): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  const pen = canvas.getContext("2d");
  if (pen) paint(pen, size);
  const texture = new CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 4;
  return texture;
}
