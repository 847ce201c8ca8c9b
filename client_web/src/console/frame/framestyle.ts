/** Where the areas of the page stand. */

import { css } from "lit";

export const frame = css`
  :host {
    display: block;
    height: 100%;
  }

  .page {
    display: flex;
    flex-direction: column;
    height: 100%;
  }

  main {
    flex: 1;
    min-height: 0;
    display: grid;
    grid-template-areas:
      "left left-bar centre right-bar right"
      "bottom-bar bottom-bar bottom-bar bottom-bar bottom-bar"
      "bottom bottom bottom bottom bottom";
    grid-template-columns: auto auto minmax(120px, 1fr) auto auto;
    grid-template-rows: minmax(120px, 1fr) auto auto;
  }

  main.narrow {
    display: block;
  }

  main.narrow esp-area {
    height: 100%;
    width: auto;
  }

  esp-area.left {
    grid-area: left;
    width: min(var(--left), 36vw);
  }

  esp-area.centre {
    grid-area: centre;
  }

  esp-area.right {
    grid-area: right;
    width: min(var(--right), 36vw);
  }

  esp-area.bottom {
    grid-area: bottom;
    height: min(var(--bottom), 60dvh);
  }

  esp-splitter.left {
    grid-area: left-bar;
    width: 6px;
  }

  esp-splitter.right {
    grid-area: right-bar;
    width: 6px;
  }

  esp-splitter.bottom {
    grid-area: bottom-bar;
    height: 6px;
  }
`;
