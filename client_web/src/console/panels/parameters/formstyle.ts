/** The look of the form of parameters, which a panel may be too narrow for. */

import { css } from "lit";

export const formStyle = css`
  :host {
    display: block;
    container-type: inline-size;
  }
  .columns {
    display: grid;
    grid-template-columns: repeat(auto-fill, minmax(min(100%, 250px), 1fr));
    gap: 4px 12px;
  }
  .head {
    margin-bottom: 8px;
  }
  .head select,
  .head input[type="search"] {
    width: 100%;
    min-width: 0;
  }
  fieldset {
    padding: 2px 4px 4px;
    border: 0;
    border-top: 1px solid var(--line);
    border-radius: 0;
  }
  .foot {
    position: sticky;
    bottom: -8px;
    z-index: 1;
    margin: 0 -8px -8px;
    padding: 6px 8px 8px;
    background: var(--paper);
    border-top: 1px solid var(--line);
  }
  .foot .row {
    flex-wrap: nowrap;
    gap: 4px;
  }
  .foot button {
    padding: 2px 7px;
    white-space: nowrap;
  }
  .foot label {
    white-space: nowrap;
  }
  .foot details {
    margin: 0;
  }
  .foot p {
    margin: 0 0 4px;
  }
  .state {
    min-height: 1.4em;
  }
`;
