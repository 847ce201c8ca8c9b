/** The keys of the whole page. */

import { byName } from "../../world/ordering";
import type { AppContext } from "../context";

export interface PageActions {
  focusArea: (step: number) => void;
  sheet: () => void;
  copyLink: () => void;
}

export function pageKeys(app: AppContext, actions: PageActions): void {
  const { state, avatars } = app;
  const nextActor = (step: number): void => {
    const keys = [...avatars.byId.values()]
      .filter(({ kind }) => kind === "actor")
      .map(({ key }) => key)
      .sort(byName);
    const at = keys.indexOf(state.chosen.value[0] ?? "");
    const next = keys[(at + step + keys.length) % keys.length];
    if (next !== undefined) app.choose(next);
  };
  app.shortcuts.add(
    { key: "?", text: "this sheet", call: actions.sheet },
    {
      key: "F6",
      text: "to the next area",
      call: () => {
        actions.focusArea(1);
      },
    },
    {
      key: "]",
      text: "choose the next actor",
      call: () => {
        nextActor(1);
      },
    },
    {
      key: "[",
      text: "choose the actor before",
      call: () => {
        nextActor(-1);
      },
    },
    {
      key: "f",
      text: "follow the chosen one on the map, or stop",
      call: () => {
        state.following.value = state.chosen.value.length > 0 && !state.following.value;
      },
    },
    { key: "l", text: "copy a link to what is shown", call: actions.copyLink },
    {
      key: "m",
      text: "show the map",
      call: () => {
        app.show("map");
      },
    },
    {
      key: "i",
      text: "show the inspector",
      call: () => {
        app.show("inspector");
      },
    },
    {
      key: "Escape",
      text: "choose nobody",
      call: () => {
        app.choose(null);
      },
    },
  );
}
