/** Draws where everybody has been: what is older as a picture, the latest piece in each frame. */

import type { Scheme } from "../state/scheme";
import { type Avatar, type Place, placeAt } from "./avatars";
import { Offscreen } from "./offscreen";
import type { MapView } from "./views";

/** The picture of trails is drawn anew this often, and whenever the map is moved. */
const AGAIN_S = 0.25;
const ALPHA = 0.55;
/** Lines that are no wider than a pixel are drawn in a fraction of the time of wider ones. */
const WIDTH_PX = 1;
/** With more avatars only the chosen ones have the long trails. */
const MANY = 100;
const SHORT_S = 10;

const place: Place = { x: 0, y: 0, z: 0, heading: 0 };

export class Trails {
  private readonly picture = new Offscreen();
  /** Where the trails of the picture end, by avatar. */
  private ends = new Map<number, Place>();
  private drawnS = Number.NEGATIVE_INFINITY;
  /** The number of times that the picture had become too old. */
  private turn = 0;

  draw(
    pen: CanvasRenderingContext2D,
    view: MapView,
    ratio: number,
    avatars: ReadonlyMap<number, Avatar>,
    timeS: number,
    trailS: number,
    chosen: ReadonlySet<string>,
    scheme: Scheme,
  ): void {
    if (trailS === 0) return;
    if (Math.abs(timeS - this.drawnS) > AGAIN_S) this.turn++;
    const of = [this.turn, trailS, scheme.dark, ...(avatars.size > MANY ? chosen : [])].join();
    this.picture.show(pen, view, ratio, of, (own) => {
      // A map that was moved shows the trails up to now.
      this.drawnS = timeS;
      this.ends = new Map();
      const length = ({ key }: Avatar): number =>
        avatars.size > MANY && !chosen.has(key) ? Math.min(SHORT_S, trailS) : trailS;
      strokeEach(own, view, avatars.values(), scheme, (avatar, line) => {
        const end = placeAt(avatar, timeS, { ...place });
        this.ends.set(avatar.id, end);
        line.to(end.x, end.y, end.z);
        avatar.trail.each(timeS - length(avatar), timeS, (x, y, z) => {
          line.to(x, y, z);
        });
      });
    });
    if (timeS === this.drawnS) return;
    strokeEach(pen, view, avatars.values(), scheme, (avatar, line) => {
      const end = this.ends.get(avatar.id);
      if (!end) return;
      placeAt(avatar, timeS, place);
      line.to(place.x, place.y, place.z);
      avatar.trail.each(this.drawnS, timeS, (x, y, z) => {
        line.to(x, y, z);
      });
      line.to(end.x, end.y, end.z);
    });
  }
}

/** A line over the map that is broken where it changes the storey, or is on one that is not shown. */
class Polyline {
  private storey: number | null = null;

  constructor(
    private readonly path: Path2D,
    private readonly view: MapView,
  ) {}

  begin(): void {
    this.storey = null;
  }

  to(x: number, y: number, z: number): void {
    const { view, path } = this;
    const storey = view.storeyOf(z);
    if (view.isShown(storey)) {
      const [px, py] = view.toCanvas(x, y, storey);
      if (storey === this.storey) path.lineTo(px, py);
      else path.moveTo(px, py);
      this.storey = storey;
    } else {
      this.storey = null;
    }
  }
}

/** One path for actors and one for people, which are stroked once each. */
function strokeEach(
  pen: CanvasRenderingContext2D,
  view: MapView,
  avatars: Iterable<Avatar>,
  scheme: Scheme,
  trace: (avatar: Avatar, line: Polyline) => void,
): void {
  const paths = { actor: new Path2D(), person: new Path2D() };
  const lines = {
    actor: new Polyline(paths.actor, view),
    person: new Polyline(paths.person, view),
  };
  for (const avatar of avatars) {
    const line = lines[avatar.kind];
    line.begin();
    trace(avatar, line);
  }
  pen.lineWidth = WIDTH_PX;
  pen.globalAlpha = ALPHA;
  for (const kind of ["actor", "person"] as const) {
    pen.strokeStyle = scheme.colour(kind);
    pen.stroke(paths[kind]);
  }
  pen.globalAlpha = 1;
}
