/** The WebGL renderer with its scene, camera, light and sky. */

import {
  AmbientLight,
  BackSide,
  BufferAttribute,
  Color,
  DirectionalLight,
  Fog,
  HemisphereLight,
  Mesh,
  MeshBasicMaterial,
  Object3D,
  PCFShadowMap,
  PerspectiveCamera,
  Scene,
  SphereGeometry,
  WebGLRenderer,
} from "three";
import type { SceneData } from "../net/messages";
import { SKY_LOW, SKY_TOP } from "./palette";
import type { Quality } from "./quality";
import type { Town } from "./town";

Object3D.DEFAULT_UP.set(0, 0, 1);

const SKY_M = 900;
const SHADOW_PIXELS = 2048;
/** The shadow map covers at most this much to every side of the middle. */
const SHADOW_REACH_M = 45;
/** Shadows are not black: walls all around throw light back. */
const SHADOW = 0.72;
const SUN = { x: -0.55, y: -0.62, z: 0.95 };

export class Renderer {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(55, 1, 0.1, 2 * SKY_M);
  private readonly webgl: WebGLRenderer;
  private readonly sun = new DirectionalLight("#fff1d6", 2.6);
  private readonly sky = skyDome();
  private town: Town | null = null;
  private shadowsAt: { x: number; y: number } | null = null;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    antialias: boolean,
  ) {
    this.webgl = new WebGLRenderer({
      canvas,
      antialias,
      powerPreference: "high-performance",
    });
    this.webgl.shadowMap.enabled = true;
    this.webgl.shadowMap.type = PCFShadowMap;
    this.scene.fog = new Fog(SKY_LOW, 70, 320);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(SHADOW_PIXELS, SHADOW_PIXELS);
    this.sun.shadow.bias = -0.0006;
    this.sun.shadow.normalBias = 0.03;
    this.sun.shadow.intensity = SHADOW;
    this.scene.add(
      this.sky,
      this.sun,
      this.sun.target,
      new HemisphereLight("#d7e8f7", "#a8977c", 1.35),
      new AmbientLight("#ffffff", 0.25),
    );
  }

  show(town: Town, { bounds: [x0, y0, x1, y1] }: SceneData): void {
    if (this.town) {
      this.scene.remove(this.town.group);
      this.town.dispose();
    }
    this.town = town;
    this.scene.add(town.group);
    const reach = Math.min(SHADOW_REACH_M, Math.hypot(x1 - x0, y1 - y0) / 2);
    const { camera } = this.sun.shadow;
    camera.left = camera.bottom = -reach;
    camera.right = camera.top = reach;
    camera.near = 1;
    camera.far = 4 * reach + 100;
    camera.updateProjectionMatrix();
    this.shadowsAt = null;
    this.lightAround((x0 + x1) / 2, (y0 + y1) / 2);
  }

  apply({ pixelRatio, shadows, livingShadows }: Quality): void {
    this.webgl.setPixelRatio(Math.min(window.devicePixelRatio, pixelRatio));
    this.resize();
    this.webgl.shadowMap.autoUpdate = livingShadows;
    this.webgl.shadowMap.needsUpdate = true;
    this.sun.castShadow = shadows;
  }

  resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    this.webgl.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / Math.max(1, clientHeight);
    // A wider angle on upright screens shows more to the sides.
    this.camera.fov = this.camera.aspect < 1 ? 68 : 55;
    this.camera.updateProjectionMatrix();
  }

  render(): void {
    const { x, y } = this.camera.position;
    this.sky.position.set(x, y, 0);
    if (this.shadowsAt && Math.hypot(x - this.shadowsAt.x, y - this.shadowsAt.y) > SHADOW_REACH_M) {
      this.lightAround(x, y);
    }
    this.webgl.render(this.scene, this.camera);
  }

  private lightAround(x: number, y: number): void {
    const far = 1.5 * SHADOW_REACH_M;
    this.sun.target.position.set(x, y, 0);
    this.sun.position.set(x + SUN.x * far, y + SUN.y * far, SUN.z * far);
    this.shadowsAt = { x, y };
    this.webgl.shadowMap.needsUpdate = true;
  }
}

/** A dome whose colour goes from the horizon's to the zenith's. */
function skyDome(): Mesh {
  const geometry = new SphereGeometry(SKY_M, 24, 12);
  const position = geometry.getAttribute("position");
  const colors = new Float32Array(position.count * 3);
  const color = new Color();
  for (let i = 0; i < position.count; i++) {
    const up = Math.max(0, position.getY(i) / SKY_M);
    color.lerpColors(SKY_LOW, SKY_TOP, Math.min(1, up * 1.6)).toArray(colors, i * 3);
  }
  geometry.setAttribute("color", new BufferAttribute(colors, 3));
  geometry.rotateX(Math.PI / 2);
  const material = new MeshBasicMaterial({
    vertexColors: true,
    side: BackSide,
    fog: false,
    depthWrite: false,
  });
  return new Mesh(geometry, material);
}
