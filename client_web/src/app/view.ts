/** The picture: everything from render/ put together, one call for each frame. */

import { FollowCamera } from "../render/follow";
import { Figures } from "../render/figures";
import { drawsInSoftware } from "../render/hardware";
import { Labels } from "../render/labels";
import { Marks } from "../render/marks";
import { Picking, type ScreenPoint } from "../render/picking";
import { Plans } from "../render/plans";
import { type Choice, QualityControl } from "../render/quality";
import { Stage } from "../render/stage";
import { buildTown, type Town } from "../render/town";
import type { Avatar, World } from "../world/world";

export class View {
  readonly camera: FollowCamera;
  readonly marks: Marks;
  private readonly stage: Stage;
  private readonly figures = new Figures();
  private readonly plans = new Plans();
  private readonly labels: Labels;
  private readonly picking: Picking;
  private control: QualityControl;
  private readonly software = drawsInSoftware();
  private town: Town | null = null;

  constructor(canvas: HTMLCanvasElement, labelLayer: HTMLElement, choice: Choice, calm: boolean) {
    this.stage = new Stage(canvas, choice === "fine" || (choice === "automatic" && !this.software));
    this.camera = new FollowCamera(this.stage.camera);
    this.marks = new Marks(calm);
    this.labels = new Labels(labelLayer);
    this.picking = new Picking(this.stage.camera);
    this.control = new QualityControl(choice, this.software);
    this.stage.scene.add(this.figures.group, this.marks.group, this.plans.group);
    this.applyQuality();
    new ResizeObserver(() => {
      this.stage.resize();
    }).observe(canvas);
  }

  /** The world that is shown from now on. */
  enter(world: World): void {
    this.town = buildTown(world.scene);
    this.stage.show(this.town, world.scene);
    this.marks.walkTarget(null);
  }

  choose(choice: Choice): void {
    this.control = new QualityControl(choice, this.software);
    this.applyQuality();
  }

  say(avatar: Avatar, text: string): void {
    this.labels.say(avatar, text);
  }

  /** What is at a point of the screen. */
  pick(
    at: ScreenPoint,
    world: World,
  ): { avatar: Avatar } | { ground: { x: number; y: number } } | null {
    const avatar = this.picking.avatar(at, world.avatars);
    if (avatar) return { avatar };
    const ground = this.picking.ground(at, this.town?.occluders ?? []);
    return ground && { ground };
  }

  frame(world: World, chosenId: number | null, frameS: number): void {
    const { own, avatars } = world;
    const chosen = chosenId === null ? undefined : avatars.get(chosenId)?.pose;
    if (own) this.camera.update(own.pose.x, own.pose.y, this.town?.occluders ?? [], frameS);
    this.town?.lookingFrom(this.camera.reachM);
    this.figures.update(avatars, frameS);
    this.marks.update(avatars, own?.pose, chosen, frameS);
    this.plans.show(world.plan);
    this.stage.draw();
    this.labels.update(avatars, this.stage.camera);
    if (this.control.frame(frameS)) this.applyQuality();
  }

  get qualityLevel(): number {
    return this.control.level;
  }

  private applyQuality(): void {
    const { quality } = this.control;
    this.stage.apply(quality);
    this.figures.castShadows(quality.livingShadows);
    this.marks.softShadows(!quality.livingShadows);
  }
}
