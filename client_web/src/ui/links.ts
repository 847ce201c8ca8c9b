/** Addresses of pages in what people say, made into links. */

import { element } from "./dom";

const ADDRESS = /https?:\/\/[^\s<>"']+/g;
/** A sentence goes on behind an address with these; they are no part of it. */
const CLOSING = /[.,;:!?)\]}…]+$/;

/** A text as nodes: addresses are links that open elsewhere and tell nothing of this page. */
export function withLinks(text: string): (Node | string)[] {
  const nodes: (Node | string)[] = [];
  let done = 0;
  for (const match of text.matchAll(ADDRESS)) {
    const address = match[0].replace(CLOSING, "");
    if (!URL.canParse(address)) continue;
    nodes.push(text.slice(done, match.index), link(address));
    done = match.index + address.length;
  }
  return [...nodes, text.slice(done)].filter((node) => node !== "");
}

function link(address: string): HTMLAnchorElement {
  const rel = "noopener noreferrer nofollow ugc";
  return element("a", { href: address, target: "_blank", rel }, address);
}
