/** The look of the panel of series, and of the charts in it. */

import uPlotStyle from "uplot/dist/uPlot.min.css?inline";
import { css, unsafeCSS } from "lit";

export const seriesStyle = [
  unsafeCSS(uPlotStyle),
  css`
    :host {
      display: block;
    }
    .charts {
      display: grid;
      grid-template-columns: repeat(auto-fill, minmax(min(100%, 340px), 1fr));
      gap: 8px 14px;
      margin-top: 8px;
    }
    figure {
      margin: 0;
      min-width: 0;
    }
    figcaption {
      display: flex;
      justify-content: space-between;
      gap: 8px;
      font-size: 0.93em;
    }
    .choice {
      display: grid;
      grid-template-columns: repeat(auto-fill, minmax(min(100%, 220px), 1fr));
      max-height: 200px;
      overflow: auto;
    }
    .told {
      min-height: 1.4em;
    }
  `,
];
