/** One visit: it joins, passes messages to the world and the page, and draws the frames. */

import { partsOf, type Wording } from "../language/phrase";
import { words } from "../language/words";
import { unpackBlock } from "../net/codec";
import { unpackSteps } from "../net/steps";
import { fetchTriangles } from "../net/triangles";
import { Connection, type ConnectionState } from "../net/connection";
import type { Seats } from "../net/seats";
import type { Admission, ServerMessage, Welcome } from "../net/messages";
import { ChatPanel } from "../ui/chat";
import { byId } from "../ui/dom";
import { JoinDialog } from "../ui/join";
import { Minimap } from "../ui/minimap";
import { NoticeBanner } from "../ui/notices";
import { Panel } from "../ui/panels";
import { PaceBanner } from "../ui/pace";
import { PlanPanel } from "../ui/plan";
import {
  arrivalIn,
  endingOf,
  faultOf,
  greetingOf,
  noticeOf,
  remarkOf,
  type Saying,
} from "../ui/sentences";
import { StatusChip } from "../ui/status";
import { surroundings } from "../ui/whereabouts";
import { World } from "../world/world";
import type { AddressWish } from "./address";
import { Cost } from "./cost";
import { Links } from "./links";
import { Looks } from "./looks";
import { Manners } from "./manners";
import { Others } from "./others";
import type { Picked, Picture } from "./picture";
import { Walking } from "./walking";

const PANELS_MS = 200;
const TOUCH_MS = 5000;
const LONGEST_FRAME_S = 0.25;
/** After these errors the avatar does not walk where its person wanted it to. */
const CALLED_OFF: ReadonlySet<string> = new Set(["no_path", "goal_moved", "lease_ended"]);

export class Session {
  world: World | null = null;
  chosenId: number | null = null;
  frames = 0;
  /** The cost of moving everybody and solving their joints. */
  readonly moving = new Cost();
  readonly connection: Connection;
  private welcome: Welcome | null = null;
  private readonly walking: Walking;
  private readonly join: JoinDialog;
  private readonly chat: ChatPanel;
  private readonly status = new StatusChip();
  private readonly pace = new PaceBanner();
  private readonly minimap: Minimap;
  private readonly manners: Manners;
  private readonly looks: Looks;
  private readonly others: Others;
  private readonly notices = new NoticeBanner();
  private readonly links: Links;
  private readonly planPanel = new PlanPanel((wanted) => {
    this.others.follow(wanted ? this.chosenId : null);
    // On a small screen one sees where one goes; the bar that names the actor ends it, too.
    if (wanted) Panel.makeRoom();
  });
  private readonly planSwitch: Panel;
  /** The operator key; null for people without one. */
  private readonly operator: string | null;
  /** The pass or invitation of this person; null for those who came by an ordinary link. */
  private admission: Admission | null;
  /** Whether the welcome that comes next is that of another zone of the same world. */
  private travels = false;
  /** The name that the person gave; the server may have added a number. */
  private wishedName = "";
  private frameMs = performance.now();
  private panelsMs = 0;

  constructor(
    private readonly view: Picture,
    private readonly seats: Seats,
    socketUrl: string,
    /** Whether the person wants little motion. */
    calm: boolean,
    wish: Omit<AddressWish, "rest" | "zone">,
  ) {
    this.operator = wish.operator;
    this.admission = wish.admission;
    this.links = new Links(view, wish, (place) => {
      this.walking.walkTo(place);
    });
    this.links.offer(() => this.world);
    this.connection = new Connection(() => new WebSocket(socketUrl), {
      state: (state) => {
        this.stateChanged(state);
      },
      message: (message) => {
        this.receive(message);
      },
    });
    this.join = new JoinDialog((name, password) => void this.comeIn(name, password));
    this.chat = new ChatPanel((text) => this.connection.send({ type: "chat", text }));
    this.walking = new Walking(
      (message) => this.connection.send(message),
      (at) => {
        view.marks.walkTarget(at);
      },
      () => {
        this.others.stopFollowing();
      },
    );
    this.planSwitch = new Panel(
      byId("plan-open", HTMLButtonElement),
      byId("plan", HTMLElement),
      (open) => {
        this.watch(open ? this.chosenId : null);
      },
    );
    new Panel(byId("people-open", HTMLButtonElement), byId("people", HTMLElement));
    this.others = new Others(
      {
        send: (message) => this.connection.send(message),
        turnTo: (id) => {
          this.turnTo(id);
        },
        choose: (id) => {
          this.choose(id);
        },
        walkTo: (place) => {
          this.walking.walkTo(place);
        },
        stand: () => {
          this.walking.stand();
        },
        linesOf: (id) => this.chat.linesOf(id),
        nameOf: (id) => this.world?.avatars.get(id)?.name ?? "",
        share: (name) => {
          this.links.sharePerson(name, this.world);
        },
        invite: (name, accept) => {
          this.links.inviteTo(name, accept);
        },
      },
      wish.follow,
    );
    this.minimap = new Minimap((at) => {
      this.act(at);
    });
    this.manners = new Manners(
      (message) => this.connection.send(message),
      calm,
      () => {
        if (this.world) this.chat.note(surroundings(this.world, view.camera.yaw));
      },
    );
    this.looks = new Looks(localStorage, calm, view.drawsFigures, (look) => {
      this.connection.wear(look);
    });
    byId("leave", HTMLButtonElement).addEventListener("click", () => {
      this.leave();
    });
  }

  /** Rejoin at once after a reload; otherwise ask for a name. */
  async start(): Promise<void> {
    window.setInterval(() => {
      if (this.connection.state.phase === "live") this.seats.touch();
    }, TOUCH_MS);
    requestAnimationFrame((ms) => {
      this.frame(ms);
    });
    const seat = await this.seats.ofThisTab();
    if (seat) {
      this.wishedName = seat.name;
      this.greet(seat.name, seat.token);
    } else this.join.open();
  }

  /** A click on the picture: an actor to look into, a door to move, or a place to walk to. */
  tap(at: { x: number; y: number }): void {
    if (!this.world) return;
    const hit = this.view.pick(at, this.welcome?.operator ?? false);
    if (!hit) return;
    this.act(hit);
  }

  private act(hit: NonNullable<Picked>): void {
    if ("floor" in hit) {
      this.others.stopFollowing();
      this.walking.walkTo(hit.floor);
    } else if ("door" in hit) {
      const open = !(this.world?.doors[hit.door] ?? true);
      this.connection.send({ type: "set_door", name: hit.door, open });
    } else this.others.open(hit.avatar);
  }

  /** Go out of the world for good; the next who comes in here is somebody new. */
  private leave(): void {
    this.connection.leave();
    this.seats.forget();
    this.others.begin();
    this.links.end();
    this.join.open(() => words.door.left);
  }

  private async comeIn(name: string, password: string): Promise<void> {
    this.join.busy(true);
    this.wishedName = name;
    if (password !== "") this.admission = { way: "password", secret: password };
    const seat = await this.seats.abandoned(name);
    this.greet(name, seat?.token ?? null);
  }

  private greet(name: string, resume: string | null): void {
    const { operator, admission } = this;
    this.connection.join({ name, resume, operator, admission, look: this.looks.choose() });
  }

  private stateChanged(state: ConnectionState): void {
    this.status.show(state);
    if (state.phase === "live" && this.welcome) {
      const { resume, resume_seconds: keptS } = this.welcome;
      void this.seats.keep(this.wishedName, resume, keptS * 1000);
      this.join.close();
      this.chat.note(this.travels ? arrivalIn(this.welcome) : greetingOf(this.welcome));
      this.travels = false;
      this.manners.begin(this.welcome);
      this.looks.begun(this.welcome);
    }
    if (state.phase === "reconnecting") this.join.wait(() => endingOf(state.ending));
    if (state.phase === "refused") {
      this.notices.hide();
      this.join.open(() => endingOf(state.ending));
    }
  }

  private receive(message: ServerMessage): void {
    const { world } = this;
    switch (message.type) {
      case "welcome":
        this.enter(message);
        break;
      case "enter":
        world?.enter(message.tick, message.entities);
        this.others.entered(message.entities);
        break;
      case "leave":
        world?.leave(message.ids);
        this.others.left(message.ids);
        if (this.chosenId !== null && message.ids.includes(this.chosenId)) this.choose(null);
        break;
      case "snapshot": {
        if (!this.welcome || !world) return;
        this.walking.acknowledged(message.ack);
        const records = unpackBlock(message.block, this.welcome.origin);
        world.snapshot(message.tick, message.ack, records, this.serverNowS());
        break;
      }
      case "steps":
        world?.steps(unpackSteps(message.block));
        break;
      case "point":
        world?.point(message.id, message.target);
        break;
      case "reshape":
        world?.reshape(message);
        break;
      case "away":
        world?.away(message.id, message.away);
        break;
      case "plan":
        if (world && message.id === this.chosenId && this.planSwitch.open) world.plan = message;
        break;
      case "chat": {
        // A line may have been under way when its speaker was muted.
        if (this.others.isMuted(message.name) && message.id !== world?.ownId) break;
        const speaker = world?.avatars.get(message.id);
        this.chat.said(message, speaker?.own ?? false);
        if (speaker) this.view.say(speaker, message.text);
        break;
      }
      case "census":
        this.others.census(message.people, message.actors);
        break;
      case "error":
        if (message.error === "password_needed") this.join.askPassword();
        if (message.error === "admission_refused") this.admission = null;
        if (CALLED_OFF.has(message.error)) {
          this.walking.callOff();
          this.others.stopFollowing();
        }
        this.chat.note(faultOf(message));
        this.others.tell(() => faultOf(message));
        break;
      case "notice":
        if (message.notice === "goal_moved") this.walking.goalMoved(message.arguments);
        if (!this.pace.show(message)) this.notice(message);
        break;
      case "hide":
        this.chat.hide(message.lines);
        break;
      case "doors":
        world?.doorsMoved(message.doors);
        break;
      case "travel":
        this.travels = true;
        break;
      case "gesture":
        if (world && !this.others.isMuted(world.avatars.get(message.id)?.name ?? "")) {
          this.manners.show(message.id, message.gesture, world, this.view);
        }
        break;
      case "bye":
      case "pong":
        break;
    }
  }

  /** A notice goes into the chat, and one of moderators into a banner too. */
  private notice(message: Extract<ServerMessage, { type: "notice" }>): void {
    const first = noticeOf(message);
    if (!first) {
      this.chat.note(remarkOf(message));
      return;
    }
    const saying = (): Saying => noticeOf(message) ?? first;
    const told = (): Wording => [...partsOf(saying().head), " ", ...partsOf(saying().words)];
    this.chat.note(told());
    const { seconds, x, y, z } = message.arguments;
    if (message.notice === "report_taken") this.others.tell(told);
    else if (message.notice === "muted") this.notices.muted(() => saying().words, Number(seconds));
    else this.notices.show(saying, ["warned", "walked_out"].includes(message.notice));
    if (typeof x === "number" && typeof y === "number" && typeof z === "number") {
      this.walking.leadTo({ x, y, z });
    }
  }

  private enter(welcome: Welcome): void {
    this.welcome = welcome;
    this.world = new World(welcome);
    this.view.enter(this.world);
    this.walking.enter(this.world);
    this.minimap.show(welcome.scene);
    this.chosenId = null;
    this.others.begin();
    if (!welcome.resumed || this.travels) this.links.begin();
    this.pace.hide();
    if (welcome.scene.mesh !== undefined) void this.build(this.world, welcome.scene.mesh);
  }

  /** Fetch the mesh that a world is made of; until it is there, its people walk on nothing. */
  private async build(world: World, address: string): Promise<void> {
    try {
      const triangles = await fetchTriangles(address);
      if (world !== this.world) return;
      world.built(triangles);
      this.view.enter(world, triangles);
      this.minimap.show(world.scene, triangles);
    } catch (error) {
      this.chat.note(words.chat.noBuilding(String(error)));
    }
  }

  /** Look at somebody who was chosen without being seen. */
  private turnTo(id: number): void {
    const avatar = this.world?.avatars.get(id);
    if (avatar) this.view.camera.turnTo(avatar.pose);
  }

  private choose(id: number | null): void {
    this.chosenId = id;
    if (this.world) this.world.plan = null;
    if (id !== null && !this.planSwitch.open) this.planSwitch.open = true;
    else this.watch(id);
  }

  private watch(id: number | null): void {
    if (id === null && this.world) this.world.plan = null;
    this.connection.send({ type: "watch", id });
  }

  private serverNowS(): number {
    return this.connection.clock.at(performance.now() / 1000);
  }

  private frame(ms: number): void {
    requestAnimationFrame((next) => {
      this.frame(next);
    });
    const frameS = Math.max(0, ms - this.frameMs) / 1000;
    this.frameMs = ms;
    this.frames++;
    const { world } = this;
    if (!world) return;
    this.links.look(world);
    const steppedS = Math.min(frameS, LONGEST_FRAME_S);
    this.view.camera.orbit(this.walking.turnPerS * steppedS, 0);
    this.walking.frame(this.view.camera.yaw);
    this.others.frame(world, ms);
    this.moving.of(() => {
      world.advance(this.serverNowS(), steppedS, this.connection.clock.rate);
    });
    const markedId = this.others.openedId ?? (this.planSwitch.open ? this.chosenId : null);
    this.view.frame(world, markedId, frameS);
    if (ms - this.panelsMs > PANELS_MS) {
      this.panelsMs = ms;
      this.updatePanels(world);
    }
  }

  private updatePanels(world: World): void {
    const name = this.chosenId === null ? null : (world.avatars.get(this.chosenId)?.name ?? null);
    this.status.roundTrip(this.connection.clock.roundTripS);
    this.others.update(world, this.chosenId, this.view.camera.yaw);
    const followed = this.chosenId !== null && this.others.followedId === this.chosenId;
    this.planPanel.update(name, world, followed);
    const { avatars, own, doors, plan } = world;
    this.minimap.update(avatars, own, doors, this.view.camera.yaw, plan);
  }
}
