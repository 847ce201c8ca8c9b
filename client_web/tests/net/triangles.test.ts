import { describe, expect, it } from "vitest";
import { fetchTriangles } from "../../src/net/triangles";

const answering =
  (body: BodyInit | null, status = 200) =>
  () =>
    Promise.resolve(new Response(body, { status }));

describe("fetchTriangles", () => {
  it("reads floats of either machine", async () => {
    const view = new DataView(new ArrayBuffer(36));
    for (let i = 0; i < 9; i++) view.setFloat32(i * 4, i + 0.5, true);
    const read = await fetchTriangles("mesh", answering(view.buffer));
    expect([...read]).toEqual([0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5]);
  });

  it.each([
    ["is not there", answering(null, 404), "the server answers 404"],
    ["is cut off", answering(new ArrayBuffer(40)), "40 bytes are no whole triangles"],
  ])("says what is wrong when it %s", async (_what, ask, reason) => {
    await expect(fetchTriangles("mesh", ask)).rejects.toThrow(reason);
  });
});
