import { describe, expect, it } from "vitest";

import type { AppContext } from "../../src/console/context";
import { pick } from "../../src/console/panels/pick";
import { State } from "../../src/console/state/state";

function page(): AppContext {
  return { state: new State(), show: () => undefined } as unknown as AppContext;
}

describe("places that are asked for", () => {
  it("end with the one point that was wanted", async () => {
    const app = page();
    const asked = pick(app, "Where to?", "point");
    app.state.picking.value?.take([1, 2, 0]);
    expect(await asked).toEqual([[1, 2, 0]]);
    expect(app.state.picking.value).toBeNull();
  });

  it("are drawn as they come, until the operator has done", async () => {
    const app = page();
    const asked = pick(app, "Stops", "line");
    app.state.picking.value?.take([1, 2, 0]);
    app.state.picking.value?.take([3, 2, 0]);
    expect(app.state.picking.value?.points).toHaveLength(2);
    app.state.picking.value?.end();
    expect(await asked).toHaveLength(2);
  });

  it("are none where the operator wants something else", async () => {
    const app = page();
    const asked = pick(app, "Stops", "line");
    const other = pick(app, "Where to?", "point");
    expect(await asked).toBeNull();
    app.state.picking.value?.end();
    expect(await other).toBeNull();
  });
});
