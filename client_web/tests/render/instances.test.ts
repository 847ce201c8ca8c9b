import { BoxGeometry, Color, Matrix4, MeshBasicMaterial, Vector3 } from "three";
import { beforeEach, describe, expect, it } from "vitest";
import { Instances } from "../../src/render/instances";

const RED = new Color("#ff0000");
const BLUE = new Color("#0000ff");
const LEFT = new Vector3(0, 1, 0);

let part: Instances;

beforeEach(() => {
  part = new Instances(new BoxGeometry(), new MeshBasicMaterial());
  part.begin();
});

/** The place in the world of a point of an instance's shape. */
function placed(x: number, y: number, z: number, index = 0): number[] {
  const matrix = new Matrix4();
  part.mesh.getMatrixAt(index, matrix);
  return new Vector3(x, y, z).applyMatrix4(matrix).toArray();
}

function expectNear(actual: number[], expected: number[]): void {
  actual.forEach((value, i) => {
    expect(value).toBeCloseTo(expected[i] ?? NaN, 5);
  });
}

describe("instances of a part", () => {
  it("hang from one joint to the next", () => {
    part.hang(1, RED, { x: 1, y: 2, z: 3 }, { x: 1.5, y: 2, z: 3 }, LEFT, 0.5);
    expectNear(placed(0, 0, -1), [1.5, 2, 3]);
    expectNear(placed(0, 1, 0), [1, 2.5, 3]);
    expectNear(placed(1, 0, 0), [1, 2, 3.5]);
  });

  it("are coloured anew when their owner wears something else", () => {
    const colour = (): number | undefined => part.mesh.instanceColor?.getX(0);
    const at = { x: 0, y: 0, z: 0 };
    const level = { w: 1, x: 0, y: 0, z: 0 };
    part.put(1, RED, at, level, 1);
    expect(colour()).toBe(1);
    part.repaint();
    part.begin();
    part.put(1, BLUE, at, level, 1);
    expect(colour()).toBe(0);
  });

  it("go on from the end of a limb", () => {
    const limb = { start: new Vector3(), hinge: new Vector3(0, 0, 2), axis: LEFT };
    part.extend(1, RED, { ...limb, end: new Vector3(0, 0, 1) }, 1);
    expectNear(placed(0, 0, -1), [0, 0, 0]);
  });

  it("are turned as a rotation says", () => {
    const quarter = { w: Math.SQRT1_2, x: 0, y: 0, z: Math.SQRT1_2 };
    part.put(1, RED, { x: 1, y: 0, z: 0 }, quarter, 2);
    expectNear(placed(1, 0, 0), [1, 2, 0]);
  });

  it("stand with the toe up where the foot points", () => {
    const foot = { heel: LEFT, toe: LEFT, pitch: 0, heading: Math.PI / 2, bend: 0 };
    part.stand(1, RED, { x: 0, y: 0, z: 0 }, foot, Math.PI / 6, 1);
    expectNear(placed(1, 0, 0), [0, Math.cos(Math.PI / 6), 0.5]);
  });

  it("keep their colours until they belong to somebody else", () => {
    part.put(1, RED, LEFT, { w: 1, x: 0, y: 0, z: 0 }, 1);
    part.finish();
    part.begin();
    part.put(1, BLUE, LEFT, { w: 1, x: 0, y: 0, z: 0 }, 1);
    const color = new Color();
    part.mesh.getColorAt(0, color);
    expect(color.equals(RED)).toBe(true);
    part.begin();
    part.put(2, BLUE, LEFT, { w: 1, x: 0, y: 0, z: 0 }, 1);
    part.mesh.getColorAt(0, color);
    expect(color.equals(BLUE)).toBe(true);
  });

  it("find room for everybody", () => {
    for (let i = 0; i < 300; i++) {
      part.put(i, RED, { x: i, y: 0, z: 0 }, { w: 1, x: 0, y: 0, z: 0 }, 1);
    }
    part.finish();
    expect(part.mesh.count).toBe(300);
    expectNear(placed(0, 0, 0, 7), [7, 0, 0]);
  });

  it("are not drawn at all when there are none", () => {
    part.finish();
    expect(part.mesh.visible).toBe(false);
  });
});
