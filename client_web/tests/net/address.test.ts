import { expect, test } from "vitest";

import { socketAddress } from "../../src/net/address";

test.each([
  ["http://localhost:8080/", "ws://localhost:8080/ws"],
  ["https://plaza.example/?x=1#operator=key", "wss://plaza.example/ws"],
  ["https://plaza.example/world/", "wss://plaza.example/world/ws"],
  ["http://[::1]:8080/a/b/index.html", "ws://[::1]:8080/a/b/ws"],
])("the socket of %s is %s", (page, socket) => {
  expect(socketAddress(page)).toBe(socket);
});

test("the socket's address names the copy of a zone that somebody wishes to enter", () => {
  expect(socketAddress("https://plaza.example/world/", "hall-2")).toBe(
    "wss://plaza.example/world/ws?zone=hall-2",
  );
});
