/** How the content of a menu lies over the page. */

import { css } from "lit";

export const popup = css`
  details > div {
    position: absolute;
    z-index: 3;
    right: 0;
    display: grid;
    gap: 2px;
    padding: 6px;
    border: 1px solid var(--line);
    border-radius: 8px;
    background: var(--paper);
    box-shadow: 0 4px 16px rgb(0 0 0 / 25%);
    white-space: nowrap;
  }
`;
