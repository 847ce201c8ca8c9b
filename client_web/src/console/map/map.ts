/** The panel of the live map. */

import { html, nothing, type PropertyValues, type TemplateResult } from "lit";
import type { MapData, Point } from "../net/types";
import { Panel } from "../panels/panel";
import { controls } from "../style/controls";
import { popup } from "../style/popup";
import { Choosing } from "./choosing";
import { PointerGestures, type Mode } from "./gestures";
import { drawScale, HeatMap } from "./heat";
import { Contacts, type ContactsMessage } from "./layers";
import { type MapOptions, USUAL } from "./options";
import { Painter } from "./painter";
import { boxOf, type Pixel } from "./picking";
import { pressed } from "./mapkeys";
import { mapStyle } from "./mapstyle";
import { ShownLayers } from "./shown";
import { legend, toolbar } from "./toolbar";
import { MapView } from "./views";

const HEAT_MS = 10_000;
/** Room below the legend. */
const BELOW_PX = 6;
const FOLLOW_PX_PER_M = 18;
/** The page tells once in so many frames how long it draws. */
const TOLD_FRAMES = 15;

class MapPanel extends Panel {
  static override styles = [controls, popup, mapStyle];

  private readonly view = new MapView();
  private readonly contacts = new Contacts();
  private readonly choosing = new Choosing(
    () => this.app,
    this.view,
    () => this.painter,
  );
  private shown: ShownLayers | null = null;
  private mode: Mode = "pan";
  private heat: HeatMap | null = null;
  private painter: Painter | null = null;
  private pen: CanvasRenderingContext2D | null = null;
  private frame = 0;
  private frames = 0;
  private isFitted = false;

  protected override begin(): void {
    const { app } = this;
    this.heat ??= new HeatMap(app.api);
    const painter = (this.painter ??= new Painter(app, this.view, this.heat, this.contacts));
    this.shown ??= new ShownLayers(app, this.heat, (layers) => {
      painter.layers = layers;
    });
    this.watch(app.state.chosen);
    this.watch(app.state.picking);
    this.watch(app.state.following);
    this.watch(app.scheme);
    this.watch(app.state.lookAt, (at) => {
      if (at) this.lookAt(at);
    });
    this.watch(app.state.world, (world) => {
      if (world) painter.doors = world.doors;
    });
    this.watch(app.live.phase, (phase) => {
      // Changes while the line was cut are asked for anew.
      if (phase === "on") void this.load();
    });
    this.hear("contacts", {}, (message: ContactsMessage) => {
      this.contacts.hear(message, performance.now() / 1000);
    });
    this.every(HEAT_MS, () => void this.askHeat());
    this.atEnd(() => {
      cancelAnimationFrame(this.frame);
      this.shown?.end();
    });
    this.shown.begin();
    void this.load();
    void this.askHeat();
    this.frame = requestAnimationFrame(this.draw);
  }

  protected override firstUpdated(): void {
    const canvas = this.canvas;
    this.pen = canvas.getContext("2d", { alpha: false });
    new PointerGestures(canvas, {
      mode: () => this.mode,
      pan: (dx, dy) => {
        this.app.state.following.value = false;
        this.view.panPx(dx, dy);
      },
      zoom: (factor, [x, y]) => {
        this.view.zoom(factor, x, y);
      },
      click: (at, adds) => {
        this.choosing.click(at, adds);
      },
      twice: () => this.app.state.picking.value?.end(),
      drawing: (ring) => {
        if (this.painter) this.painter.ring = ring;
      },
      region: (ring, adds) => {
        this.choosing.within(ring, adds);
      },
      hover: (at) => {
        canvas.title = this.choosing.nameAt(at);
      },
    });
    new ResizeObserver(() => {
      this.resize();
    }).observe(canvas);
  }

  protected override updated(changes: PropertyValues): void {
    super.updated(changes);
    const scale = this.renderRoot.querySelector<HTMLCanvasElement>("canvas.scale");
    if (scale) drawScale(scale);
  }

  protected override render(): TemplateResult {
    const { state } = this.app;
    const picking = state.picking.value;
    return html`
      <div class="bar" role="toolbar" aria-label="Map">
        ${toolbar({
          mode: this.mode,
          options: this.options,
          storeys: this.painter?.map?.storeys ?? [],
          only: this.view.only,
          following: state.following.value,
          mayFollow: state.chosen.value.length > 0,
          setMode: (mode) => {
            this.mode = mode;
            this.requestUpdate();
          },
          set: (change) => {
            this.setOptions(change);
          },
          show: (storey) => {
            this.showStorey(storey);
          },
          follow: (on) => {
            state.following.value = on;
          },
          zoom: (factor) => {
            this.view.zoom(factor);
          },
          fit: () => {
            this.fit();
          },
        })}
      </div>
      <div class="ground">
        <canvas
          class="map ${this.mode === "pan" && !picking ? "" : "drawing"}"
          tabindex="0"
          role="application"
          aria-label="Map: arrows move it, plus and minus zoom, 0 shows all, Enter chooses the nearest to the middle"
          @keydown=${this.key}
        ></canvas>
        ${
          picking
            ? html`<div class="asked row" role="status">
                <span>${picking.text}</span>
                <button
                  @click=${() => {
                    picking.end();
                  }}
                >
                  Done
                </button>
              </div>`
            : nothing
        }
        ${legend(this.options, this.heat?.most ?? null, this.app.scheme.value.dark)}
      </div>
    `;
  }

  private get options(): MapOptions {
    return this.shown?.options ?? USUAL;
  }

  private get canvas(): HTMLCanvasElement {
    const canvas = this.renderRoot.querySelector<HTMLCanvasElement>("canvas.map");
    if (!canvas) throw new Error("the map is not drawn yet");
    return canvas;
  }

  private async load(): Promise<void> {
    const map = await this.attempt(this.app.api.get<MapData>("/map"));
    if (!map || !this.painter) return;
    this.painter.map = map;
    this.painter.doors = Object.fromEntries(map.doors.map(({ name, open }) => [name, open]));
    this.view.setWorld(
      map.bounds,
      map.storeys.map(({ z_m }) => z_m),
    );
    if (!this.isFitted) this.fit();
    this.requestUpdate();
  }

  private fit(): void {
    this.app.state.following.value = false;
    // The legend lies over the map, in as many lines as it needs.
    const legend = this.renderRoot.querySelector<HTMLElement>(".legend");
    this.view.fit(legend ? Math.min(legend.offsetHeight + BELOW_PX, this.view.height / 3) : 0);
    this.isFitted = this.view.width > 1;
  }

  private resize(): void {
    const { canvas, view } = this;
    const ratio = Math.min(2, devicePixelRatio);
    view.width = Math.max(1, canvas.clientWidth);
    view.height = Math.max(1, canvas.clientHeight);
    canvas.width = Math.round(view.width * ratio);
    canvas.height = Math.round(view.height * ratio);
    if (!this.isFitted && this.painter?.map) this.fit();
  }

  private readonly draw = (): void => {
    this.frame = requestAnimationFrame(this.draw);
    const { pen, painter, view } = this;
    if (!pen || !painter || view.width <= 1) return;
    const nowS = performance.now() / 1000;
    this.follow();
    painter.paint(pen, pen.canvas.width / view.width, nowS, this.options);
    if (this.frames++ % TOLD_FRAMES === 0) pen.canvas.dataset["ms"] = painter.tookMs.toFixed(2);
  };

  private follow(): void {
    const { state, avatars } = this.app;
    const [first] = state.chosen.value;
    const avatar = first === undefined ? undefined : avatars.get(first);
    if (!state.following.value || !avatar) return;
    const drawn = this.painter?.drawn.find((one) => one.avatar === avatar);
    if (this.view.only !== null) this.view.only = this.view.storeyOf(avatar.to.z);
    if (drawn) this.view.panPx(this.view.width / 2 - drawn.px, this.view.height / 2 - drawn.py);
    else this.view.lookAt(avatar.to.x, avatar.to.y, this.view.storeyOf(avatar.to.z));
    if (this.view.scale < FOLLOW_PX_PER_M) this.view.zoom(FOLLOW_PX_PER_M / this.view.scale);
  }

  private lookAt([x, y, z]: Point): void {
    const storey = this.view.storeyOf(z);
    if (this.view.only !== null) this.view.only = storey;
    this.app.state.following.value = false;
    this.view.lookAt(x, y, storey);
    if (this.view.scale < FOLLOW_PX_PER_M) this.view.zoom(FOLLOW_PX_PER_M / this.view.scale);
    this.app.state.lookAt.value = null;
  }

  private showStorey(storey: number | null): void {
    this.view.only = storey;
    this.fit();
    this.requestUpdate();
  }

  private setOptions(change: Partial<MapOptions>): void {
    this.shown?.set(change);
    if (change.heat ?? change.heatS) void this.askHeat();
    this.requestUpdate();
  }

  private async askHeat(): Promise<void> {
    if (this.shown) await this.attempt(this.shown.askHeat());
    this.requestUpdate();
  }

  private readonly key = (event: KeyboardEvent): void => {
    pressed(event, this.view, {
      fit: () => {
        this.fit();
      },
      choose: () => {
        const { view } = this;
        const middle: Pixel = [view.width / 2, view.height / 2];
        if (this.app.state.picking.value) this.choosing.click(middle, false);
        else this.app.choose(this.choosing.keyAt(middle, Number.POSITIVE_INFINITY));
      },
      chooseAll: () => {
        const { view } = this;
        this.choosing.within(boxOf([0, 0], [view.width, view.height]), false);
      },
      moved: () => {
        this.app.state.following.value = false;
      },
    });
  };
}

customElements.define("esp-map", MapPanel);
