/** How controls look in every element of the page. */

import { css } from "lit";

export const controls = css`
  :host {
    color: var(--ink);
  }

  * {
    box-sizing: border-box;
  }

  [hidden] {
    display: none !important;
  }

  button,
  input,
  select,
  textarea {
    font: inherit;
    color: inherit;
  }

  button,
  select,
  input:not([type="checkbox"], [type="radio"], [type="range"]),
  textarea {
    min-height: 28px;
    padding: 2px 9px;
    border: 1px solid var(--control-line);
    border-radius: 6px;
    background: var(--paper);
  }

  button {
    cursor: pointer;
    background: var(--raised);
  }

  button:hover:not(:disabled) {
    border-color: var(--accent);
  }

  button.plain {
    border-color: transparent;
    background: none;
  }

  button[type="submit"],
  button.main {
    background: var(--accent);
    border-color: var(--accent);
    color: var(--accent-ink);
    font-weight: 600;
  }

  button[aria-pressed="true"],
  [role="tab"][aria-selected="true"] {
    background: var(--accent-wash);
    border-color: var(--accent);
  }

  button:disabled {
    opacity: 0.55;
    cursor: default;
  }

  input[type="checkbox"],
  input[type="radio"],
  input[type="range"],
  progress,
  meter {
    accent-color: var(--accent);
  }

  :focus-visible {
    outline: 2px solid var(--focus);
    outline-offset: 1px;
  }

  h2,
  h3 {
    margin: 0 0 6px;
    font-size: 1em;
  }

  p {
    margin: 0 0 6px;
  }

  a {
    color: var(--accent);
  }

  kbd {
    padding: 0 5px;
    border: 1px solid var(--control-line);
    border-radius: 4px;
    background: var(--raised);
    font: inherit;
  }

  table {
    border-collapse: collapse;
    width: 100%;
    font-variant-numeric: tabular-nums;
  }

  th,
  td {
    padding: 2px 6px;
    text-align: left;
    vertical-align: top;
    border-bottom: 1px solid var(--line);
  }

  th {
    color: var(--soft-ink);
    font-weight: 600;
  }

  .soft {
    color: var(--soft-ink);
  }

  .fault {
    color: var(--fault);
  }

  .warn {
    color: var(--warn);
  }

  .row > h2 {
    margin: 0;
  }

  .row {
    display: flex;
    flex-wrap: wrap;
    gap: 6px;
    align-items: center;
  }

  .visually-hidden {
    position: absolute;
    width: 1px;
    height: 1px;
    overflow: hidden;
    clip-path: inset(50%);
    white-space: nowrap;
  }

  @media (prefers-reduced-motion: reduce) {
    * {
      transition: none !important;
      animation: none !important;
    }
  }
`;
