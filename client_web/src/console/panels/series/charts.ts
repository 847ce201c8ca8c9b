/** All charts of the panel, one for each chosen figure, in the places that its page has for them. */

import type { LitElement } from "lit";
import type { Mark, SeriesWindow } from "../../models/series";
import { Chart, type ChartLook } from "./chart";

const HEIGHT = 104;

interface Source {
  /** The times and the values of a figure. */
  data: (name: string) => ReturnType<SeriesWindow["data"]>;
  marks: () => readonly Mark[];
  /** Called with the moment under the pointer, in microseconds. */
  hover: (us: number | null) => void;
}

export class Charts {
  private readonly charts = new Map<string, Chart>();
  private looked: ChartLook | null = null;

  constructor(
    private readonly panel: LitElement,
    private readonly source: Source,
  ) {}

  get secondsPerPixel(): number {
    const [chart] = this.charts.values();
    return chart?.secondsPerPixel ?? 1;
  }

  /** Make the charts that are missing, and take those away that are not chosen any more. */
  update(chosen: readonly string[]): void {
    const look = (this.looked ??= this.look());
    for (const figure of this.panel.renderRoot.querySelectorAll<HTMLElement>(
      "figure[data-series]",
    )) {
      const name = figure.dataset["series"] ?? "";
      const at = figure.querySelector<HTMLElement>(".plot");
      if (!at || at.childElementCount > 0) continue;
      this.charts.get(name)?.destroy();
      const chart = new Chart(at, Math.max(200, figure.clientWidth), {
        title: name,
        unit: "",
        look,
        height: HEIGHT,
        hover: (atS) => {
          this.source.hover(atS === null ? null : Math.round(atS * 1e6));
        },
        marks: this.source.marks,
      });
      this.charts.set(name, chart);
      this.fill(name, chart);
    }
    for (const [name, chart] of this.charts) {
      if (chosen.includes(name)) continue;
      chart.destroy();
      this.charts.delete(name);
    }
  }

  draw(): void {
    for (const [name, chart] of this.charts) this.fill(name, chart);
  }

  /** Point at a moment in all charts. */
  point(us: number | null): void {
    const [first] = this.charts.values(); // the others follow it
    first?.point(us === null ? null : us / 1e6);
  }

  resize(): void {
    for (const [name, chart] of this.charts) {
      const figure = this.panel.renderRoot.querySelector(
        `figure[data-series="${CSS.escape(name)}"]`,
      );
      if (figure) chart.resize(figure.clientWidth, HEIGHT);
    }
  }

  /** Take all charts away; they are made anew, in the colours of then. */
  clear(): void {
    this.looked = null;
    for (const chart of this.charts.values()) chart.destroy();
    this.charts.clear();
  }

  private fill(name: string, chart: Chart): void {
    const [times = [], values = []] = this.source.data(name);
    chart.show(times, values);
  }

  private look(): ChartLook {
    const style = getComputedStyle(this.panel);
    const of = (name: string): string => style.getPropertyValue(name).trim();
    return { line: of("--accent"), ink: of("--soft-ink"), grid: of("--line"), mark: of("--warn") };
  }
}
