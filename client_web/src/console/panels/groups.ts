/** Groups of actors: by tag, and by purpose, of which an actor has one at most. */

import { css, html, nothing, type TemplateResult } from "lit";
import { groupsOf, shortId, type Tagged } from "../models/scopes";
import { CommandingPanel } from "./commanding";

interface Group {
  group: string;
  purpose: string | null;
  actors: readonly string[];
}

class GroupsPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      li {
        padding: 4px 0;
        border-bottom: 1px solid var(--line);
      }
    `,
  ];
  private groups: readonly Group[] = [];
  private actors: readonly Tagged[] = [];

  protected override begin(): void {
    this.watch(this.app.state.chosen);
    this.hearAbout(/group|actor|revert/, () => void this.load());
    void this.load();
  }

  protected override render(): TemplateResult {
    const chosen = this.chosen();
    const nobody = chosen.length === 0 ? "Choose actors first, here or on the map." : null;
    const why = this.whyNot("set_group") ?? nobody;
    return html`
      ${this.refused()}
      <ul class="plain" aria-label="Groups">
        ${this.all().map((group) => this.row(group, chosen, nobody))}
      </ul>
      ${this.groups.length === 0 ? html`<p class="soft">There are no groups with a purpose yet.</p>` : nothing}
      <form
        @submit=${(event: SubmitEvent) => {
          event.preventDefault();
          void this.make(event.currentTarget as HTMLFormElement, chosen);
        }}
      >
        <fieldset>
          <legend>Put ${chosen.length} chosen into a group</legend>
          <div class="row">
            <label class="field grow">
              Purpose
              <input name="purpose" required pattern="[a-z0-9][a-z0-9\\-]*" placeholder="kind" />
            </label>
            <label class="field grow">
              Name
              <input name="name" required pattern="[a-z0-9][a-z0-9\\-]*" placeholder="hurried" />
            </label>
            <button type="submit" ?disabled=${why !== null} title=${why ?? ""}>Put in</button>
          </div>
          <p class="soft">An actor leaves the group that it had for the same purpose.</p>
        </fieldset>
      </form>
    `;
  }

  private row(group: Group, chosen: readonly string[], nobody: string | null): TemplateResult {
    const isTag = !group.group.includes(":");
    const members = group.actors.map(shortId).join(", ");
    const tag = isTag ? "Actors are tagged as they come in." : null;
    const set = (remove: boolean): unknown =>
      this.carryOut({ op: "set_group", group: group.group, actors: chosen, remove }).then(() =>
        this.load(),
      );
    return html`<li>
      <div class="row">
        <span class="grow"
          ><b>${group.group}</b>
          <span class="soft">${group.actors.length} ${isTag ? "by tag" : ""}</span></span
        >
        <button
          @click=${() => {
            this.app.choose(group.actors);
          }}
        >
          Choose
        </button>
        ${this.button("Add chosen", "set_group", () => set(false), { blocked: tag ?? nobody })}
        ${this.button("Take chosen out", "set_group", () => set(true), { blocked: tag ?? nobody })}
      </div>
      <div class="soft">${members.length > 160 ? `${members.slice(0, 160)} …` : members}</div>
    </li>`;
  }

  /** Groups with a purpose, then those by tag. */
  private all(): Group[] {
    const named = new Set(this.groups.map((one) => one.group));
    const tags = [...new Set(this.actors.flatMap((actor) => actor.tags))].filter(
      (tag) => !named.has(tag),
    );
    return [
      ...this.groups,
      ...tags.sort().map((tag) => ({
        group: tag,
        purpose: null,
        actors: this.actors.filter((one) => groupsOf(one).includes(tag)).map((one) => one.id),
      })),
    ];
  }

  private chosen(): string[] {
    return this.app.state.chosen.value.filter((id) => !id.startsWith("person:"));
  }

  private async make(form: HTMLFormElement, actors: readonly string[]): Promise<void> {
    const given = new FormData(form);
    const group = `${given.get("purpose") as string}:${given.get("name") as string}`;
    if (await this.carryOut({ op: "set_group", group, actors }, `They are in ${group}.`))
      form.reset();
    await this.load();
  }

  private async load(): Promise<void> {
    const found = await this.ask<{ groups: Group[] }>("/groups");
    if (found) this.groups = found.groups;
    const actors = await this.app.api.get<{ actors: Tagged[] }>("/actors").catch(() => null);
    if (actors) this.actors = actors.actors;
    this.requestUpdate();
  }
}

customElements.define("esp-groups", GroupsPanel);
