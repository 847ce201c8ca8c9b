/** A figure that turns on its own, for somebody who chooses how to look. */

import {
  AmbientLight,
  DirectionalLight,
  HemisphereLight,
  PerspectiveCamera,
  Scene,
  WebGLRenderer,
} from "three";
import type { Look } from "../net/messages";
import { Animator } from "../world/animator";
import { buildOf } from "../world/skeleton";
import type { Avatar } from "../world/world";
import { Figures } from "./figures";

/** A stature of this many lengths of the leg, as most bodies have. */
const STATURE_LEGS = 1.852;
const TURN_PER_S = 0.7;
/** The side that is seen first, and always by those who want little motion. */
const FIRST_YAW = 0.5;
/** The tallest figure fits between these heights, metres. */
const LOW_M = -0.12;
const HIGH_M = 2.12;
const FOV_DEG = 24;
/** Where a processor draws, more frames than this are wasted. */
const FRAME_MS = 40;
const OWN = 1;

export class Mannequin {
  private readonly canvas = document.createElement("canvas");
  private readonly webgl: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(FOV_DEG, 1, 0.1, 50);
  private readonly figures = new Figures();
  private avatar: Avatar | null = null;
  private yaw = FIRST_YAW;
  private drawnMs = -Infinity;
  private request = 0;

  /** It fills its host and turns, or is still for those who want little motion (`calm`). */
  constructor(
    host: HTMLElement,
    private readonly calm: boolean,
  ) {
    const { canvas } = this;
    host.append(canvas);
    const { clientWidth, clientHeight } = host;
    this.webgl = new WebGLRenderer({ canvas, alpha: true, antialias: true });
    this.webgl.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.webgl.setSize(clientWidth, clientHeight);
    const sun = new DirectionalLight("#fff1d6", 2.2);
    sun.position.set(3, -2, 4);
    this.figures.fineUpTo(Infinity);
    this.figures.castShadows(false);
    this.scene.add(
      this.figures.group,
      sun,
      new HemisphereLight("#d7e8f7", "#a8977c", 1.35),
      new AmbientLight("#ffffff", 0.3),
    );
    const middleM = (LOW_M + HIGH_M) / 2;
    const awayM = (HIGH_M - LOW_M) / 2 / Math.tan((FOV_DEG * Math.PI) / 360);
    this.camera.aspect = clientWidth / Math.max(1, clientHeight);
    this.camera.position.set(awayM, 0, middleM + 0.35);
    this.camera.lookAt(0, 0, middleM);
    this.camera.updateProjectionMatrix();
    this.next();
  }

  wear(look: Look): void {
    const statureM = look[5] / 100;
    const pose = { x: 0, y: 0, z: 0, layer: 0, heading: this.yaw, speed: 0, reason: 0 };
    const animator = new Animator(buildOf(statureM / STATURE_LEGS, statureM), pose);
    const [id, own, away] = [OWN, true, false];
    this.avatar = { id, own, away, look, pose, animator, kind: "person", name: "", radius: 0 };
    this.drawnMs = -Infinity;
  }

  dispose(): void {
    cancelAnimationFrame(this.request);
    this.figures.dispose();
    this.webgl.dispose();
    // A browser has few contexts, and one that is lost cannot be had again by its canvas.
    this.webgl.forceContextLoss();
    this.canvas.remove();
  }

  private next(): void {
    this.request = requestAnimationFrame((ms) => {
      this.draw(ms);
      this.next();
    });
  }

  private draw(ms: number): void {
    const { avatar } = this;
    const passedMs = ms - this.drawnMs;
    if (!avatar || passedMs < FRAME_MS) return;
    const isFirst = passedMs === Infinity;
    if (this.calm && !isFirst) return;
    this.drawnMs = ms;
    if (!isFirst) this.yaw += (Math.min(passedMs, 200) / 1000) * TURN_PER_S;
    avatar.pose.heading = this.yaw;
    avatar.animator.advance(0, { ...avatar.pose }, 0);
    this.figures.update(new Map([[OWN, avatar]]), this.camera);
    this.webgl.render(this.scene, this.camera);
  }
}
