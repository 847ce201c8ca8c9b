/** The picture: everything from render/ put together, one call for each frame. */

import { Cutaway } from "../render/cutaway";
import { FollowCamera } from "../render/follow";
import { Figures } from "../render/figures";
import { firstYaw, namedYaw } from "../render/firstview";
import { drawsInSoftware } from "../render/hardware";
import { SkeletonOverlay } from "../render/skeletonoverlay";
import { Labels } from "../render/labels";
import { Marks } from "../render/marks";
import { Picking, type ScreenPoint } from "../render/picking";
import { Plans } from "../render/plans";
import { type Choice, QualityControl } from "../render/quality";
import { Renderer } from "../render/renderer";
import { buildTown, type Town } from "../render/town";
import { words } from "../language/words";
import { STOREYS_APART_M } from "../world/heights";
import type { Triangles } from "../world/mesh";
import type { Avatar, World } from "../world/world";
import { Cost } from "./cost";
import type { Picked, Picture } from "./picture";

/** The names of people on other storeys are drawn with this opacity. */
const DIMMED = 0.45;

export class View implements Picture {
  readonly camera: FollowCamera;
  readonly marks: Marks;
  readonly skeletons = new SkeletonOverlay();
  readonly drawsFigures = true;
  /** The cost of placing every part of every figure. */
  readonly placing = new Cost();
  private readonly renderer: Renderer;
  private readonly figures = new Figures();
  private readonly plans = new Plans();
  private readonly labels: Labels;
  private readonly picking: Picking;
  private readonly cutaway = new Cutaway();
  /** The avatars that are drawn in this frame: all but those on floors that are cut away. */
  private readonly drawn = new Map<number, Avatar>();
  private control: QualityControl;
  private readonly software = drawsInSoftware();
  private town: Town | null = null;

  constructor(canvas: HTMLCanvasElement, labelLayer: HTMLElement, choice: Choice, calm: boolean) {
    this.renderer = new Renderer(
      canvas,
      choice === "fine" || (choice === "automatic" && !this.software),
    );
    this.camera = new FollowCamera(this.renderer.camera, calm);
    this.marks = new Marks(calm);
    this.labels = new Labels(labelLayer, () => words.people.away);
    this.picking = new Picking(this.renderer.camera);
    this.control = new QualityControl(choice, this.software);
    this.renderer.scene.add(
      this.figures.group,
      this.skeletons.group,
      this.marks.group,
      this.plans.group,
    );
    this.applyQuality();
    new ResizeObserver(() => {
      this.renderer.resize();
    }).observe(canvas);
  }

  enter(world: World, mesh: Triangles | null = null): void {
    this.town = buildTown(world, this.cutaway, mesh);
    this.renderer.show(this.town, world.scene);
    this.marks.walkTarget(null);
  }

  lookAround({ own, avatars, scene }: World): void {
    const { town } = this;
    if (!own || !town) return;
    const here = own.pose;
    const named = namedYaw(here, scene.spawns ?? []);
    if (named !== null) {
      this.camera.yaw = named;
      return;
    }
    const others = [...avatars.values()]
      .filter(({ own: isOwn, pose }) => !isOwn && Math.abs(pose.z - here.z) < STOREYS_APART_M)
      .map(({ pose }) => pose);
    this.camera.yaw = firstYaw(here, others, (yaw) =>
      this.picking.freeM(here, yaw, town.occluders),
    );
  }

  choose(choice: Choice): void {
    this.control = new QualityControl(choice, this.software);
    this.applyQuality();
  }

  say(avatar: Avatar, text: string): void {
    this.labels.say(avatar, text);
  }

  pick(at: ScreenPoint, doors: boolean): Picked {
    const { picking, town, cutaway } = this;
    if (!town) return null;
    const avatar = picking.avatar(at, this.drawn);
    if (avatar) return { avatar };
    const door = doors ? picking.door(at, town, cutaway) : null;
    if (door !== null) return { door };
    const floor = picking.floor(at, town.occluders, cutaway);
    return floor && { floor };
  }

  frame(world: World, chosenId: number | null, frameS: number): void {
    const { own, avatars } = world;
    const chosen = chosenId === null ? undefined : avatars.get(chosenId)?.pose;
    if (own && this.town) {
      const { x, y, z } = own.pose;
      const hidden = this.camera.update(own.pose, this.town.occluders, this.cutaway, frameS);
      const covered = world.floors.covered(x, y, z);
      this.cutaway.update(own.pose, this.renderer.camera.position, hidden || covered, frameS);
    }
    this.town?.doors.update(world.doors, frameS);
    this.drawn.clear();
    for (const avatar of avatars.values()) {
      if (this.shown(avatar) > 0.5) this.drawn.set(avatar.id, avatar);
    }
    this.placing.of(() => {
      this.figures.update(this.drawn, this.renderer.camera);
    });
    this.skeletons.update(this.drawn);
    this.marks.update(this.drawn, own?.pose, chosen, frameS);
    this.plans.show(world.plan, world.floors);
    this.renderer.render();
    this.labels.update(avatars, this.renderer.camera, (avatar) => {
      const apart = own !== null && Math.abs(avatar.pose.z - own.pose.z) > STOREYS_APART_M;
      return this.shown(avatar) * (apart ? DIMMED : 1);
    });
    if (this.control.frame(frameS)) this.applyQuality();
  }

  get qualityLevel(): number {
    return this.control.level;
  }

  /** The share of somebody that is left while floors above the own avatar are cut away. */
  private shown({ own, pose: { x, y, z } }: Avatar): number {
    return own ? 1 : this.cutaway.shown(x, y, z);
  }

  private applyQuality(): void {
    const { quality } = this.control;
    this.renderer.apply(quality);
    this.figures.castShadows(quality.livingShadows);
    this.figures.fineUpTo(quality.fineFiguresM);
    this.marks.softShadows(!quality.livingShadows);
  }
}
