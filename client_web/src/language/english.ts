/** All words of the page in English: the catalogue that the others follow. */

import type { Blocker, MoveReason, Outlook, Whereabouts } from "./arguments";
import { key, type Phrase, partsOf, type Wording } from "./phrase";
import { speechOf } from "./speech";

const { say, plural, metres, centimetres, seconds, milliseconds, span, moment } = speechOf("en-GB");

const SIDES = {
  ahead: "ahead",
  aheadLeft: "ahead to the left",
  left: "to the left",
  behindLeft: "behind to the left",
  behind: "behind",
  behindRight: "behind to the right",
  right: "to the right",
  aheadRight: "ahead to the right",
};
const FLOORS = { same: "", above: ", further up", below: ", further down" };
const APPROACHES = { nearer: ", comes nearer", further: ", goes away" };

const MOVED: Record<MoveReason, string> = {
  inside_wall: "That place is inside a wall or something solid",
  near_wall: "That place is too near a wall or an edge",
  no_ground: "There is no floor at that place",
  other_region: "No way leads to that place",
};

function people(count: number): Phrase {
  return plural(count, { one: say`${count} person`, other: say`${count} people` });
}

function actors(count: number): Phrase {
  return plural(count, { one: say`${count} actor`, other: say`${count} actors` });
}

function near(count: number): Phrase {
  return plural(count, { one: say`${count} person near`, other: say`${count} people near` });
}

function where({ distanceM, side, floor, away, approach }: Whereabouts): Phrase {
  const aside = `, ${SIDES[side]}${FLOORS[floor]}${away ? ", away from the screen" : ""}`;
  return [...metres(distanceM), aside, approach === null ? "" : APPROACHES[approach]];
}

function blocker(who: Blocker): Phrase {
  switch (who.kind) {
    case "named":
      return say`${who.name}`;
    case "door":
      return say`the door “${who.name}”`;
    case "unnamedDoor":
      return say`a door`;
    case "unseen":
      return say`somebody out of sight`;
    case "somebody":
      return say`somebody`;
    case "wall":
      return say`a wall`;
    case "route":
      return say`a way that is still being found`;
    case "something":
      return say`something`;
  }
}

export const english = {
  language: "Language",
  close: "Close",
  picture: "The world. Walk with W A S D or the arrow keys; click the ground to walk there.",
  noConnection: "Not sent: there is no connection at the moment.",
  tooLong: (over: number, most: number) =>
    plural(over, {
      one: say`That is ${over} character too long; ${most} are the most.`,
      other: say`That is ${over} characters too long; ${most} are the most.`,
    }),

  status: {
    idle: "Not connected",
    connecting: "Connecting…",
    live: "Connected",
    reconnecting: "Reconnecting…",
    refused: "Outside",
    roundTrip: milliseconds,
    comingBack: (why: Wording) => say`${partsOf(why)} Coming back by itself…`,
  },

  bar: {
    panels: "Panels",
    people: "People",
    plans: "Plans",
    help: "Help",
    share: "Share",
    shareHint: "A link to where you are",
    leave: "Leave",
  },

  door: {
    what: "A place where people and computer-run actors walk among each other.",
    flat: "This browser draws no 3D here, so a map is your picture. Everything else is as for all.",
    name: "Your name",
    password: "The password of this place",
    look: "Choose how you look",
    comeIn: "Come in",
    comingIn: "Coming in…",
    noName: "Please give a name that one can see.",
    noPassword: "Please give the password.",
    tryingAgain: (why: Wording) => say`${partsOf(why)} Trying again…`,
    left: "You have left. Come in again whenever you like.",
  },

  look: {
    title: "How you look",
    figure: "You, as others see you",
    surprise: "Surprise me",
    stature: "Stature",
    centimetres,
    wear: "Look like this",
    stay: "Stay as I am",
    parts: {
      shirt: "Shirt",
      trousers: "Trousers",
      hair: "Hair",
      hairColour: "Hair colour",
      skin: "Skin",
    },
    shirts: {
      red: "red",
      blue: "blue",
      amber: "amber",
      green: "green",
      violet: "violet",
      linen: "linen",
      slate: "slate",
      rose: "rose",
      teal: "teal",
      brown: "brown",
      black: "black",
      lime: "lime",
    },
    trousers: {
      ink: "ink",
      greyBlue: "grey-blue",
      khaki: "khaki",
      navy: "navy",
      grey: "grey",
      stone: "stone",
      rust: "rust",
      cream: "cream",
    },
    hairdos: { short: "short", long: "long", bun: "bun", curls: "curls", shaven: "shaven" },
    hairColours: {
      darkBrown: "dark brown",
      brown: "brown",
      chestnut: "chestnut",
      blond: "blond",
      grey: "grey",
      black: "black",
      red: "red",
      white: "white",
    },
    skins: {
      skin1: "1, the lightest",
      skin2: "2",
      skin3: "3",
      skin4: "4",
      skin5: "5",
      skin6: "6",
      skin7: "7",
      skin8: "8, the darkest",
    },
  },

  people: {
    inView: "In view",
    find: "Find a name",
    findHint: "Find a name…",
    people: "People",
    actors: "Actors",
    showPlan: "show plan",
    you: "you",
    away: "away",
    muted: "muted",
    awayAndMuted: "away, muted",
    inWorld: (personCount: number, actorCount: number) =>
      say`${people(personCount)} and ${actors(actorCount)} in the world`,
  },

  card: {
    where,
    find: "Find",
    follow: "Follow",
    wave: "Wave",
    share: "Share",
    mute: "Mute for me",
    unmute: "Unmute",
    reportMore: "Report…",
    report: "Report",
    tell: "Tell those who look after this place",
    whys: {
      rude: "is rude or threatens",
      unfit: "says what is not fit for here",
      inTheWay: "gets in the way on purpose",
      pretends: "pretends to be somebody else",
      other: "something else",
    },
    line: "About a line",
    noLine: "none of their lines",
    words: "In your words",
    sending: "Sending…",
  },

  following: {
    whom: (name: string) => say`You follow ${name}.`,
    end: "Follow no more",
  },

  links: {
    toPlace: "The link leads to a place here.",
    toPerson: (name: string) => say`The link leads to ${name}, who is here.`,
    walk: "Walk there",
    follow: "Follow",
    stay: "Stay",
    copied: "The link is copied.",
    copy: "Copy this link:",
  },

  map: {
    map: "Map of the place, north is up",
    floors: "Floor that the map shows",
    floor: (storey: number) => (storey === 0 ? say`Ground floor` : say`Floor ${storey}`),
    /** So short that a button of 20 pixels holds it. */
    sign: (storey: number) => (storey === 0 ? say`G` : say`${storey}`),
  },

  plan: {
    panel: "Plan of an actor",
    none: "No actor chosen",
    choose: "Click an actor, or choose one under People.",
    awaited: "…",
    follow: "Follow",
    followNoMore: "Follow no more",
    joinTour: "Join the tour",
    leaveTour: "Leave the tour",
    stops: "Stops of the tour",
    stop: (number: number) => say`Stop ${number}`,
    led: (others: number) =>
      others === 0
        ? say`You are on this tour.`
        : say`You are on this tour, with ${people(others)} more.`,
    others: (count: number) =>
      count === 0 ? say`Nobody is on this tour yet.` : say`${people(count)} on this tour.`,
    path: "path, a dot each second",
    soon: "where people may be soon",
    late: "and later",
    behaviours: {
      go_to: (place: string | null) =>
        place === null ? say`goes to a place` : say`goes to a place, now to: ${place}`,
      wander: (place: string | null) =>
        place === null
          ? say`wanders between places`
          : say`wanders between places, now to: ${place}`,
      patrol: (place: string | null) =>
        place === null ? say`patrols its round` : say`patrols its round, now to: ${place}`,
      guide: (place: string | null) =>
        place === null ? say`guides a tour` : say`guides a tour, now to: ${place}`,
      idle: (place: string | null) =>
        place === null ? say`has nothing to do` : say`has nothing to do, now to: ${place}`,
    },
    /** A behaviour that this page does not know. */
    unknown: (behaviour: string, place: string | null) =>
      place === null ? say`${behaviour}` : say`${behaviour}, now to: ${place}`,
    asNear: (who: Blocker) => say`is as near to its goal as it gets: ${blocker(who)} is there`,
    blocked: (who: Blocker) => say`has given up: ${blocker(who)} is in its way`,
    noWay: "has given up: no way leads to its goal",
    moving: "moving along its path",
    givingWay: (to: Blocker) => say`giving way to ${blocker(to)}`,
    waiting: "waiting",
    waitingFor: (whom: Blocker) => say`waiting for ${blocker(whom)}`,
    replanning: "looking for another way",
    noPath: "finds no way to its goal",
    arrived: "has arrived",
    noReason: "no reason given",
    outlook: (reach: Outlook, count: number) => {
      switch (reach.path) {
        case "toGoal":
          return say`there in ${seconds(reach.seconds)}, ${near(count)}`;
        case "part":
          return say`path for ${seconds(reach.seconds)}, ${near(count)}`;
        case "none":
          return say`no path, ${near(count)}`;
        case "over":
          return near(count);
      }
    },
  },

  chat: {
    chat: "Chat",
    said: "What was said",
    say: "Say something",
    hint: "Say something…",
    send: "Say",
    welcome: (name: string) => say`Welcome, ${name}. See Help for how to get about.`,
    welcomeBack: (name: string) => say`Welcome back, ${name}.`,
    arrived: (scene: string) => say`You have come to ${scene}.`,
    noBuilding: (fault: string) => say`The building cannot be shown: ${fault}.`,
  },

  around: {
    somebody: (name: string, there: Whereabouts) => say`${name}, ${where(there)}.`,
    place: (name: string, { distanceM, side }: Pick<Whereabouts, "distanceM" | "side">) =>
      say`The place ${name} is ${metres(distanceM)} ${[SIDES[side]]}.`,
    more: (count: number) => say`${count} more further away.`,
    nobody: "Nobody is near.",
    /** Sentences of the above, one after the other. */
    together: (sentences: readonly Wording[]) =>
      sentences.flatMap((each, i) => [i === 0 ? "" : " ", ...partsOf(each)]),
  },

  stick: "Stick for walking: drag it with your thumb",

  gestures: {
    title: "Gestures",
    look: "Your look…",
    names: {
      wave: "Wave",
      nod: "Nod",
      point: "Point",
      clap: "Clap",
      dance: "Dance",
      raise_hand: "Raise hand",
    },
    /** Shown above the head. */
    labels: {
      wave: "waves",
      nod: "nods",
      point: "points",
      clap: "claps",
      dance: "dances",
      raise_hand: "raises a hand",
    },
    they: {
      wave: (name: string) => say`${name} waves.`,
      nod: (name: string) => say`${name} nods.`,
      point: (name: string) => say`${name} points.`,
      clap: (name: string) => say`${name} claps.`,
      dance: (name: string) => say`${name} dances.`,
      raise_hand: (name: string) => say`${name} raises a hand.`,
    },
    you: {
      wave: "You wave.",
      nod: "You nod.",
      point: "You point.",
      clap: "You clap.",
      dance: "You dance.",
      raise_hand: "You raise a hand.",
    },
  },

  help: {
    title: "How to get about",
    walk: say`${key("W")} ${key("A")} ${key("S")} ${key("D")} or arrows`,
    walkDoes: say`walk, turn with ${key("Q")} and ${key("E")}; with ${key("Shift")} run`,
    ground: "Click or tap the ground",
    groundDoes: "walk there, around what is in the way",
    drag: "Drag",
    dragDoes: "look around; wheel or pinch comes nearer",
    talk: say`${key("Enter")}`,
    talkDoes: say`talk to those near by; ${key("Esc")} leaves the line`,
    actor: "Click an actor",
    actorDoes:
      "see its path, its reason, and where it expects people to be; follow it, or join the tour of a guide",
    person: "Click a person",
    personDoes: "find, follow, greet, mute or report them; the list of people has the same",
    gestures: say`${key("1")} to ${key("6")}`,
    gesturesDo: say`wave, nod, point, clap, dance, raise a hand; ${key("G")} opens their menu, where you change your look too`,
    around: say`${key("L")}`,
    aroundDoes: "have said in the chat who and what is around you",
    map: "Click the map",
    mapDoes: "walk there, or choose whom you have clicked",
    floors: "Floors under the map",
    floorsDo: "look at another floor; what is above you in the picture gives way",
    caps: "Those with a green cap are actors: the computer walks them.",
    drawing: "Drawing",
    automatic: "automatic",
    fine: "fine",
    fast: "fast",
    skeletons: "Show footprints, joints, and what legs and arms reach for",
    licences: "Licences of the libraries in this page",
  },

  notices: {
    announcement: "Announcement",
    muted: (mutedS: number) => say`You are muted for ${span(mutedS)}.`,
    mutedYet: (mutedS: number) => say`You are muted for ${span(mutedS)} more.`,
    unmuted: "You are heard again.",
    warned: "A moderator warns you.",
    walkedOut: "You are being walked to the way out.",
    reportTaken: "Thank you.",
    reportRead: "The people who look after this place can read your report now.",
    notLetIn: "You are not let in there just now.",
    /** The reason for that, as the server says it. */
    notLetInWhy: (why: string) => say`${why}.`,
    goalMoved: (why: MoveReason, movedM: number) =>
      say`${[MOVED[why]]}; you walk to the nearest one, ${metres(movedM)} from it.`,
    paused:
      "The world is paused: an operator has stopped time for a moment. Nobody moves, and you keep your place. You can go on talking.",
    silent:
      "This place does not answer just now. Nobody moves, and you keep your place; it goes on by itself in a moment.",
    heard: "The place goes on.",
    resumed: "The world goes on as usual.",
    usual: "Time runs as usual again.",
    slow: (factor: number) =>
      say`Time runs slowly here just now: ${factor} times as fast as usual.`,
    quick: (factor: number) => say`Time runs fast here just now: ${factor} times as fast as usual.`,
    behind: (factor: number, rate: number) =>
      say`Time is to run ${factor} times as fast as usual, but the server manages only ${rate} times.`,
  },

  faults: {
    muted: (mutedS: number) => say`Nobody heard that: you are muted for ${span(mutedS)} more.`,
    slowMode: (waitS: number) =>
      say`Nobody heard that: it is slow mode, so wait for ${span(waitS)}.`,
    wordRefused: "Nobody heard that: there is a word in it that is not said here.",
    quietZone: (zone: string | null) =>
      zone === null
        ? say`Nobody heard that: where you stand it is quiet.`
        : say`Nobody heard that: where you stand it is quiet (${zone}).`,
    noPath: "No way leads there.",
    forbidden: "Only operators open and close doors.",
    leaseEnded: "You stand still, because nothing came from this page for a while.",
    other: (text: string) => say`The server says: ${text}.`,
  },

  endings: {
    normal: "The server ended the connection.",
    goingAway: "The server is going down for a moment.",
    tooLarge: "This page sent a message that is too large.",
    busy: "The place does not answer just now.",
    unsupportedVersion: "The server speaks another version. Please reload this page.",
    malformed: "The server could not read a message of ours.",
    invalid: "The server refused what this page sent.",
    flooding: "Too many messages in too short a time.",
    helloExpected: "The server did not get our greeting.",
    helloTimeout: "Our greeting came too late.",
    serverFull: "The place is full. Please try again later.",
    tooSlow: "This connection is too slow to follow the world.",
    replaced: "Your avatar went on in another window. This one is at rest.",
    silent: "Nothing came from this page for a while.",
    nameReserved: "That name cannot be had here.",
    admissionNeeded: "Not everybody can come in here: the way in is an invitation.",
    passwordNeeded: "Not everybody can come in here: the way in is an invitation or its password.",
    admissionRefused: "You were not let in.",
    banned: "You cannot come in here.",
    kicked: "An operator has asked you to leave.",
    lost: "The connection was lost.",
    serverSilent: "The server fell silent.",
    noAnswer: "The server does not answer.",
    unreadable: "The server sent something unreadable.",
  },
  /** An ending, with what the server says of it. */
  endingSaid: (ending: string, said: Wording) => say`${[ending]} (${partsOf(said)})`,
  bannedUntil: (words: string, end: Date) => say`${words} You may come back after ${moment(end)}.`,
  bannedForGood: (words: string) => say`${words} No end is set.`,
};

/** Every language has the same words, with the same arguments. */
export type Catalogue = typeof english;
