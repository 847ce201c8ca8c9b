/** Where the interfaces are, seen from the page; a proxy may serve all of it below a path. */

export interface Addresses {
  api: string;
  live: string;
}

/** The path before the page, and the zone that it is about if it names one. */
const PAGE = /^(?<root>.*?)(?:\/zones\/(?<zone>[^/]+))?\/console(?:\.html|\/.*)?$/;

/** The page about another zone; a proxy may serve all of it below a path. */
export function pageOfZone(page: URL, zone: string): string {
  const root = PAGE.exec(page.pathname)?.groups?.["root"] ?? "";
  return `${page.origin}${root}/zones/${zone}/console/`;
}

export function addressesOf(page: URL): Addresses {
  const { root, zone } = PAGE.exec(page.pathname)?.groups ?? {};
  const api = `${page.origin}${root ?? ""}/api/v1${zone === undefined ? "" : `/zones/${zone}`}`;
  return { api, live: `${api.replace(/^http/, "ws")}/live` };
}
