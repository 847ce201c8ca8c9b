/*
 * A field of walkers on Colyseus: the same input, interest and rate as Esplanade's, and no steps.
 *
 * node world.mjs '{"people", "side_m", "view_m", "view_limit", "tick_rate", "max_speed"}'
 *
 * It prints one JSON line, {"port", "paths"}: a path of the WebSocket for each seat, as all seats
 * are reserved beforehand. It ends with its standard input. A client sends messages of type 1,
 * [direction, speed]. It sees the nearest others within the distance, looks every fourth tick, and
 * loses them 15 % further off.
 */

import { Room, Server, matchMaker } from "@colyseus/core";
import { MapSchema, StateView, schema, t } from "@colyseus/schema";
import { WebSocketTransport } from "@colyseus/ws-transport";

const options = JSON.parse(process.argv[2]);
const MOVE = 1;
const LOOK_TICKS = 4;
const KEEP = 1.15;
const CM = 100;
const BYTE_TURN = 256 / (2 * Math.PI);
const SQUARE_M = 6;
const SEATS_S = 900;
const HOST = "127.0.0.1";

const Avatar = schema({ x: t.int16(), y: t.int16(), heading: t.uint8() }, "Avatar");
const World = schema({ avatars: t.map(Avatar).view() }, "World");

/** A person: the exact place, the wish, the avatar that clients are told of, and who is in view. */
class Walker {
  constructor(number, client) {
    this.number = number;
    this.client = client;
    this.x = Math.random() * options.side_m;
    this.y = Math.random() * options.side_m;
    this.direction = 0;
    this.speed = 0;
    this.avatar = new Avatar();
    this.seen = new Set();
  }

  move(tick_s) {
    if (this.speed > 0) {
      const way = this.speed * tick_s;
      this.x = within(this.x + way * Math.cos(this.direction));
      this.y = within(this.y + way * Math.sin(this.direction));
    }
    this.avatar.x = Math.round(this.x * CM);
    this.avatar.y = Math.round(this.y * CM);
    this.avatar.heading = Math.round(this.direction * BYTE_TURN) & 255;
  }
}

class Field extends Room {
  onCreate() {
    this.maxClients = options.people;
    this.seatReservationTimeout = SEATS_S;
    this.maxMessagesPerSecond = Infinity;
    this.autoDispose = false;
    this.patchRate = null;
    this.state = new World({ avatars: new MapSchema() });
    this.walkers = new Map();
    this.numbers = 0;
    this.ticks = 0;
    this.onMessage(MOVE, (client, [direction, speed]) => {
      const walker = this.walkers.get(client.sessionId);
      walker.direction = direction;
      walker.speed = Math.min(speed, options.max_speed);
    });
    this.setSimulationInterval(() => this.tick(), 1000 / options.tick_rate);
  }

  onJoin(client) {
    client.view = new StateView();
    const walker = new Walker(this.numbers++, client);
    walker.move(0);
    this.walkers.set(client.sessionId, walker);
    this.state.avatars.set(client.sessionId, walker.avatar);
    client.view.add(walker.avatar);
    this.look(walker, this.buckets());
  }

  onLeave(client) {
    const gone = this.walkers.get(client.sessionId);
    this.walkers.delete(client.sessionId);
    this.state.avatars.delete(client.sessionId);
    for (const walker of this.walkers.values()) walker.seen.delete(gone);
  }

  tick() {
    this.ticks += 1;
    for (const walker of this.walkers.values()) walker.move(1 / options.tick_rate);
    const buckets = this.buckets();
    for (const walker of this.walkers.values())
      if ((walker.number + this.ticks) % LOOK_TICKS === 0) this.look(walker, buckets);
    this.broadcastPatch();
  }

  /** Everyone, by squares. */
  buckets() {
    const buckets = new Map();
    for (const walker of this.walkers.values()) {
      const key = square(Math.floor(walker.x / SQUARE_M), Math.floor(walker.y / SQUARE_M));
      if (!buckets.has(key)) buckets.set(key, []);
      buckets.get(key).push(walker);
    }
    return buckets;
  }

  look(walker, buckets) {
    const near = nearest(walker, buckets);
    const seen = new Set(near.map(([, other]) => other));
    for (const other of walker.seen)
      if (!seen.has(other)) walker.client.view.remove(other.avatar);
    for (const other of seen)
      if (!walker.seen.has(other)) walker.client.view.add(other.avatar);
    walker.seen = seen;
  }
}

/** The nearest others: rings of squares are searched until no nearer one can be outside. */
function nearest(walker, buckets) {
  const reach = KEEP * options.view_m;
  const column = Math.floor(walker.x / SQUARE_M);
  const row = Math.floor(walker.y / SQUARE_M);
  const near = [];
  for (let ring = 0; (ring - 1) * SQUARE_M <= reach; ring++) {
    for (let i = -ring; i <= ring; i++) {
      const step = Math.abs(i) === ring ? 1 : 2 * ring;
      for (let j = -ring; j <= ring; j += step)
        for (const other of buckets.get(square(column + i, row + j)) ?? []) {
          if (other === walker) continue;
          const d = (other.x - walker.x) ** 2 + (other.y - walker.y) ** 2;
          const limit = walker.seen.has(other) ? reach : options.view_m;
          if (d <= limit ** 2) near.push([d, other]);
        }
    }
    if (near.length < options.view_limit) continue;
    const sure = (ring * SQUARE_M) ** 2;
    let inside = 0;
    for (const [d] of near) inside += d <= sure;
    if (inside >= options.view_limit) break;
  }
  near.sort((a, b) => a[0] - b[0]);
  near.length = Math.min(near.length, options.view_limit);
  return near;
}

function within(metres) {
  return Math.min(Math.max(metres, 0), options.side_m);
}

function square(column, row) {
  return 65536 * column + row;
}

const transport = new WebSocketTransport({ pingInterval: 0 });
const server = new Server({ transport, greet: false, gracefullyShutdown: false });
server.define("field", Field);
await server.listen(0, HOST);
const room = await matchMaker.createRoom("field", {});
const seats = [];
for (let k = 0; k < options.people; k++) seats.push(await matchMaker.reserveSeatFor(room, {}));
const paths = seats.map(
  (seat) => `/${room.processId}/${room.roomId}?sessionId=${seat.sessionId}`,
);
console.log(JSON.stringify({ port: transport.server.address().port, paths }));
process.stdin.resume();
process.stdin.on("end", () => process.exit(0));
