/** Presets: named sets of values, with versions; applied, saved, compared and kept as files. */

import { css, html, nothing, type TemplateResult } from "lit";
import { comparing } from "../models/comparing";
import { keepFile } from "../models/files";
import { shown } from "../models/fields";
import { type Preset, readPreset, toJson, toToml } from "../models/presetfiles";
import { scopeName } from "../models/scopes";
import { clock } from "../models/times";
import { CommandingPanel } from "./commanding";

interface PresetRow extends Preset {
  shipped?: boolean;
  by?: string | null;
  at_us?: number | null;
}

class PresetsPanel extends CommandingPanel {
  static override styles = [
    ...CommandingPanel.styles,
    css`
      li {
        padding: 6px 0;
        border-bottom: 1px solid var(--line);
      }
      li p {
        margin: 2px 0;
      }
    `,
  ];
  private presets: readonly PresetRow[] = [];
  private scopes: readonly string[] = ["world"];
  private scope = "world";
  private versions = new Map<string, number>();

  protected override begin(): void {
    void this.load();
    this.hearAbout(/preset|group|parameter|revert/, () => void this.load());
    this.watch(this.app.state.chosen);
  }

  protected override render(): TemplateResult {
    const chosen = this.app.state.chosen.value.filter((id) => !id.startsWith("person:"));
    const scopes = [...new Set([...this.scopes, ...chosen.map((id) => `actor:${id}`)])];
    return html`
      <div class="row">
        <label class="field grow">
          Apply to
          <select
            @change=${(event: Event) => {
              this.scope = (event.currentTarget as HTMLSelectElement).value;
              this.requestUpdate();
            }}
          >
            ${scopes.map(
              (scope) =>
                html`<option value=${scope} ?selected=${scope === this.scope}>
                  ${scopeName(scope)}
                </option>`,
            )}
          </select>
        </label>
        ${this.importer()}
      </div>
      ${this.refused()}
      <ul class="plain" aria-label="Presets">
        ${this.presets.map((preset) => this.row(preset))}
      </ul>
      ${this.saver()}
    `;
  }

  private row(preset: PresetRow): TemplateResult {
    const { name, note, shipped, values } = preset;
    const version = this.versions.get(name) ?? preset.version;
    const whence = shipped
      ? "came along"
      : `${preset.by ?? ""} ${preset.at_us ? clock(preset.at_us) : ""}`;
    return html`<li>
      <div class="row">
        <b class="grow">${name}</b>
        <label>
          <span class="visually-hidden">Version of ${name}</span>
          <select
            @change=${(event: Event) => {
              this.versions.set(name, Number((event.currentTarget as HTMLSelectElement).value));
              this.requestUpdate();
            }}
          >
            ${Array.from({ length: preset.version }, (_, index) => preset.version - index).map(
              (number) =>
                html`<option value=${number} ?selected=${number === version}>v${number}</option>`,
            )}
          </select>
        </label>
        ${this.button(
          "Apply",
          "apply_preset",
          () =>
            this.carryOut(
              { op: "apply_preset", scope: this.scope, preset: name, version },
              `${name} is applied to ${scopeName(this.scope)}.`,
            ),
          { main: true, label: `Apply ${name} to ${scopeName(this.scope)}` },
        )}
      </div>
      ${note ? html`<p>${note}</p>` : nothing}
      <details>
        <summary class="soft">${Object.keys(values).length} values, ${whence.trim()}</summary>
        <p>
          ${Object.entries(values).map(
            ([field, value]) => html`<span class="chip">${field} ${shown(value)}</span> `,
          )}
        </p>
        <div class="row">
          <button @click=${() => void this.keep(preset, version, "toml")}>Export as TOML</button>
          <button @click=${() => void this.keep(preset, version, "json")}>as JSON</button>
          <button
            @click=${() => {
              comparing.value = ["default", `preset:${name}`, this.scope];
              this.app.show("difference");
            }}
          >
            Compare
          </button>
          ${this.button(
            "Delete",
            "delete_preset",
            () => this.carryOut({ op: "delete_preset", name }, `${name} is deleted.`),
            { blocked: shipped ? "It came along with the server and stays." : null },
          )}
        </div>
      </details>
    </li>`;
  }

  private saver(): TemplateResult {
    return html`<form
      @submit=${(event: SubmitEvent) => {
        event.preventDefault();
        void this.save(event.currentTarget as HTMLFormElement);
      }}
    >
      <fieldset>
        <legend>Save what is set in ${scopeName(this.scope)}</legend>
        <div class="row">
          <label class="field grow">
            Name
            <input
              name="name"
              required
              pattern="[a-z0-9][a-z0-9\\-]{0,31}"
              title="small letters, digits and hyphens"
            />
          </label>
          <label class="field grow"
            >What it is good for <input name="note" maxlength="500"
          /></label>
          <button
            type="submit"
            ?disabled=${this.whyNot("save_preset") !== null}
            title=${this.whyNot("save_preset") ?? ""}
          >
            Save
          </button>
        </div>
      </fieldset>
    </form>`;
  }

  private importer(): TemplateResult {
    return html`<label class="field grow">
      Import TOML or JSON
      <input
        type="file"
        accept=".toml,.json"
        ?disabled=${this.whyNot("save_preset") !== null}
        title=${this.whyNot("save_preset") ?? ""}
        @change=${(event: Event) => void this.take(event.currentTarget as HTMLInputElement)}
      />
    </label>`;
  }

  private async save(form: HTMLFormElement): Promise<void> {
    const given = new FormData(form);
    const name = given.get("name") as string;
    const note = (given.get("note") as string).trim();
    const command = { op: "save_preset", name, from_scope: this.scope };
    const answer = await this.carryOut(note ? { ...command, note } : command, `${name} is saved.`);
    if (answer) form.reset();
    await this.load();
  }

  private async take(input: HTMLInputElement): Promise<void> {
    const [file] = input.files ?? [];
    if (!file) return;
    try {
      const { name, note, values } = await readPreset(await file.text(), file.name);
      const command = { op: "save_preset", name, values };
      await this.carryOut(note ? { ...command, note } : command, `${name} is imported.`);
      await this.load();
    } catch (error) {
      const text = error instanceof Error ? error.message : String(error);
      this.app.toast(`${file.name}: ${text}`, "fault");
    }
    input.value = "";
  }

  private async keep(preset: PresetRow, version: number, kind: "toml" | "json"): Promise<void> {
    let found: Preset | undefined = preset;
    if (version !== preset.version) {
      const asked = this.app.api.get<Preset>(`/presets/${preset.name}`, { version });
      found = await this.attempt(asked);
    }
    if (!found) return;
    const text = kind === "toml" ? toToml(found) : toJson(found);
    keepFile(`${preset.name}.${kind}`, text);
  }

  private async load(): Promise<void> {
    const found = await this.ask<{ presets: PresetRow[] }>("/presets");
    if (found) this.presets = found.presets;
    const parameters = await this.ask<{ scopes: Record<string, unknown> }>("/parameters");
    const groups = await this.ask<{ groups: { group: string }[] }>("/groups");
    this.scopes = [
      ...new Set([
        "world",
        ...Object.keys(parameters?.scopes ?? {}),
        ...(groups?.groups ?? []).map((one) => `group:${one.group}`),
      ]),
    ];
    this.requestUpdate();
  }
}

customElements.define("esp-presets", PresetsPanel);
