/** Where the interfaces are, seen from the page; a proxy may serve all of it below a path. */

export interface Addresses {
  api: string;
  live: string;
}

export function addressesOf(page: URL): Addresses {
  const root = /^(.*?)\/console(?:\.html|\/.*)?$/.exec(page.pathname)?.[1] ?? "";
  const api = `${page.origin}${root}/api/v1`;
  return { api, live: `${api.replace(/^http/, "ws")}/live` };
}
