/** The areas of the page around the map, or all panels as tabs of one where there is no room. */

import { html, nothing, type TemplateResult } from "lit";
import type { AreaLayout } from "../layout/layout";
import { type Area, panelOf } from "../panels/registry";
import type { AreaWish } from "./area";
import "./area";
import "./splitter";

export interface Areas {
  /** The panels of an area that the account may see. */
  visible: (name: Area) => AreaLayout;
  content: (panel: string) => HTMLElement | null;
  wish: (event: CustomEvent<AreaWish>) => void;
  resize: (name: Area, size: number) => void;
}

/** An area without the panels for which a right is missing. */
export function allowed(
  { panels, active, size }: AreaLayout,
  may: (right: string) => boolean,
): AreaLayout {
  const left = panels.filter((id) => {
    const entry = panelOf(id);
    return entry !== undefined && may(entry.right);
  });
  return { panels: left, active: left.find((id) => id === active) ?? left[0] ?? null, size };
}

export function wide(areas: Areas): TemplateResult {
  const has = (name: Area): boolean => areas.visible(name).panels.length > 0;
  const area = (name: Area): TemplateResult => element(areas, name, areas.visible(name), false);
  return html`
    ${has("left") ? html`${area("left")}${splitter(areas, "left", "Width of the left area")}` : nothing}
    ${area("centre")}
    ${
      has("right")
        ? html`${splitter(areas, "right", "Width of the right area")}${area("right")}`
        : nothing
    }
    ${
      has("bottom")
        ? html`${splitter(areas, "bottom", "Height of the bottom area")}${area("bottom")}`
        : nothing
    }
  `;
}

/** All panels as tabs of one area; `front` is the panel that was shown last. */
export function alone(areas: Areas, front: string): TemplateResult {
  const order: readonly Area[] = ["centre", "left", "right", "bottom"];
  const panels = order.flatMap((area) => areas.visible(area).panels);
  const active = panels.includes(front) ? front : (panels[0] ?? null);
  return element(areas, "centre", { panels, active, size: 0 }, true);
}

function element(
  { content, wish }: Areas,
  name: Area,
  { panels, active }: AreaLayout,
  isAlone: boolean,
): TemplateResult {
  return html`<esp-area
    class=${name}
    .name=${name}
    .panels=${panels}
    .active=${active}
    .content=${active === null ? null : content(active)}
    .alone=${isAlone}
    @wish=${wish}
  ></esp-area>`;
}

function splitter({ visible, resize }: Areas, name: Area, label: string): TemplateResult {
  return html`<esp-splitter
    class=${name}
    .label=${label}
    .size=${visible(name).size}
    .grows=${name === "left" ? 1 : -1}
    ?across=${name === "bottom"}
    @resized=${(event: CustomEvent<number>) => {
      resize(name, event.detail);
    }}
  ></esp-splitter>`;
}
