/** How the inspector looks. */

import { css } from "lit";

export const inspectorStyle = css`
  h2 {
    font-size: 16px;
  }

  .row {
    margin-bottom: 6px;
  }

  section {
    margin-top: 14px;
  }

  dl {
    display: grid;
    grid-template-columns: max-content 1fr;
    gap: 2px 10px;
    margin: 0;
  }

  dt {
    color: var(--soft-ink);
  }

  dd {
    margin: 0;
    overflow-wrap: anywhere;
  }

  .band {
    position: relative;
    height: 22px;
    border-radius: 4px;
    background: var(--raised);
    overflow: hidden;
  }

  .band span {
    position: absolute;
    top: 0;
    bottom: 0;
  }

  .stops {
    margin: 6px 0 0;
    padding: 0;
    list-style: none;
    max-height: 180px;
    overflow: auto;
  }

  .stops li {
    display: flex;
    gap: 5px;
    align-items: baseline;
    padding: 1px 0;
  }

  .stops .grow {
    flex: 1;
  }

  .stops .soft {
    white-space: nowrap;
  }

  .dot {
    flex: none;
    width: 9px;
    height: 9px;
  }

  th.name {
    color: inherit;
    font-weight: 400;
  }

  .set {
    color: var(--accent);
    font-weight: 600;
  }

  /* Bars of all columns are as long as their values. */
  .costs {
    table-layout: fixed;
  }

  .costs th:first-child {
    width: 40%;
  }

  .bar {
    display: block;
    height: 4px;
    border-radius: 2px;
    background: var(--accent);
  }

  .bar.risk,
  .bar.others {
    background: var(--fault);
  }

  .slice {
    display: flex;
    gap: 8px;
    align-items: center;
  }

  .slice input {
    flex: 1;
    min-width: 60px;
  }
`;
