/**
 * The address of the socket beside a page, encrypted if the page is. It names the copy of the zone
 * for newcomers that somebody wishes to enter, if they wish for one.
 */
export function socketAddress(page: string, zone: string | null = null): string {
  const address = new URL("ws", page);
  address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
  if (zone !== null) address.searchParams.set("zone", zone);
  return address.href;
}
