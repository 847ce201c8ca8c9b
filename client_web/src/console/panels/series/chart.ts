/** One chart over time, with a line for each change and a pointer that all charts share. */

import uPlot from "uplot";
import { shown } from "../../models/fields";
import type { Mark } from "../../models/series";
import { tickTexts } from "../../models/times";

export interface ChartLook {
  readonly line: string;
  readonly ink: string;
  readonly grid: string;
  readonly mark: string;
}

export interface ChartWishes {
  readonly title: string;
  readonly unit: string;
  readonly look: ChartLook;
  readonly height: number;
  /** The moment under the pointer in seconds; null when it leaves. */
  readonly hover: (atS: number | null) => void;
  readonly marks: () => readonly Mark[];
}

const KEY = "esplanade";

export class Chart {
  private readonly plot: uPlot;
  /** Whether the pointer is being moved from outside, which is not told back. */
  private isTold = false;

  constructor(at: HTMLElement, width: number, wishes: ChartWishes) {
    const { look, height } = wishes;
    const rule = { stroke: look.grid, width: 1 };
    const axis = { stroke: look.ink, grid: rule, ticks: rule };
    this.plot = new uPlot(
      {
        width,
        height,
        cursor: { sync: { key: KEY }, y: false, points: { size: 6 } },
        legend: { show: false },
        scales: { x: { time: true }, y: { range: (_, low, high) => around(low, high) } },
        series: [{}, { stroke: look.line, width: 1.5, spanGaps: false, points: { show: false } }],
        axes: [
          {
            ...axis,
            size: 24,
            space: 70,
            font: "11px system-ui",
            values: (_, splits) => tickTexts(splits),
          },
          {
            ...axis,
            size: 52,
            font: "11px system-ui",
            values: (_, splits) => splits.map((value) => shown(value)),
          },
        ],
        hooks: {
          draw: [
            (plot) => {
              drawMarks(plot, wishes.marks(), look.mark);
            },
          ],
          setCursor: [
            (plot) => {
              if (this.isTold) return;
              const { left } = plot.cursor;
              wishes.hover(left === undefined || left < 0 ? null : plot.posToVal(left, "x"));
            },
          ],
        },
      },
      [[], []],
      at,
    );
  }

  show(times: readonly (number | null)[], values: readonly (number | null)[]): void {
    this.plot.setData([times as number[], values as number[]]);
  }

  resize(width: number, height: number): void {
    if (width > 0 && width !== this.plot.width) this.plot.setSize({ width, height });
  }

  /** Move the pointer to a moment that another panel has pointed at. */
  point(atS: number | null): void {
    const left = atS === null ? -10 : this.plot.valToPos(atS, "x");
    this.isTold = true;
    this.plot.setCursor({ left, top: atS === null ? -10 : 10 }, true);
    this.isTold = false;
  }

  /** The seconds that a pixel stands for. */
  get secondsPerPixel(): number {
    const { min, max } = this.plot.scales["x"] ?? {};
    const width = this.plot.over.clientWidth;
    return min === undefined || max === undefined || width === 0 ? 1 : (max - min) / width;
  }

  destroy(): void {
    this.plot.destroy();
  }
}

/** A range with some room, from zero where the values are near it. */
function around(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || (low === 0 && high === 0)) return [0, 1];
  const from = low >= 0 && low < 0.5 * high ? 0 : low;
  const room = Math.max(1e-6, (high - from) * 0.08);
  return high === from ? [from - 0.5, high + 0.5] : [from === 0 ? 0 : from - room, high + room];
}

function drawMarks(plot: uPlot, marks: readonly Mark[], colour: string): void {
  const { ctx, bbox } = plot;
  const { min, max } = plot.scales["x"] ?? {};
  if (min === undefined || max === undefined) return;
  ctx.save();
  ctx.strokeStyle = colour;
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
  ctx.beginPath();
  for (const mark of marks) {
    const atS = mark.atUs / 1e6;
    if (atS < min || atS > max) continue;
    const x = Math.round(plot.valToPos(atS, "x", true)) + 0.5;
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
  }
  ctx.stroke();
  ctx.restore();
}
