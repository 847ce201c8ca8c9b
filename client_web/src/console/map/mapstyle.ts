/** How the panel of the map looks. */

import { css } from "lit";

export const mapStyle = css`
  :host {
    display: flex;
    flex-direction: column;
    height: 100%;
    position: relative;
  }

  .bar {
    display: flex;
    flex-wrap: wrap;
    gap: 4px 10px;
    padding: 4px 6px;
    align-items: center;
    border-bottom: 1px solid var(--line);
  }

  .bar label {
    display: inline-flex;
    gap: 4px;
    align-items: center;
  }

  .group {
    display: inline-flex;
    gap: 2px;
  }

  .ground {
    flex: 1;
    min-height: 0;
    position: relative;
  }

  canvas.map {
    position: absolute;
    inset: 0;
    width: 100%;
    height: 100%;
    touch-action: none;
    cursor: grab;
  }

  canvas.map:focus-visible {
    outline-offset: -3px;
    outline-width: 3px;
  }

  canvas.map.drawing {
    cursor: crosshair;
  }

  .asked {
    position: absolute;
    top: 6px;
    left: 50%;
    transform: translateX(-50%);
    max-width: calc(100% - 16px);
    padding: 6px 10px;
    border: 1px solid var(--accent);
    border-radius: 8px;
    background: var(--paper);
  }

  .legend {
    position: absolute;
    left: 6px;
    bottom: 6px;
    max-width: calc(100% - 12px);
    padding: 3px 8px;
    border: 1px solid var(--line);
    border-radius: 6px;
    background: var(--paper);
    font-size: 12px;
  }

  .dot {
    display: inline-block;
    width: 9px;
    height: 9px;
    margin-right: 4px;
  }

  .dot.person {
    border-radius: 50%;
    background: var(--person);
  }

  details {
    position: relative;
  }

  summary {
    padding: 3px 9px;
    border: 1px solid var(--control-line);
    border-radius: 6px;
    background: var(--raised);
    cursor: pointer;
  }

  details > div {
    right: auto;
    left: 0;
    gap: 6px;
    padding: 10px;
  }
`;
