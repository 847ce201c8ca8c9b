/** The mesh of a building from the server: 32-bit floats, little-endian, nine a triangle. */

const TRIANGLE_BYTES = 36;

/** Corners x, y, z in metres, z up; rejects with a reason for people. */
export async function fetchTriangles(
  address: string,
  ask: (address: string) => Promise<Response> = fetch,
): Promise<Float32Array> {
  const answer = await ask(address);
  if (!answer.ok) throw new Error(`the server answers ${answer.status}`);
  const bytes = await answer.arrayBuffer();
  if (bytes.byteLength % TRIANGLE_BYTES !== 0) {
    throw new Error(`${bytes.byteLength} bytes are no whole triangles`);
  }
  const view = new DataView(bytes);
  return Float32Array.from({ length: bytes.byteLength / 4 }, (_, i) =>
    view.getFloat32(i * 4, true),
  );
}
