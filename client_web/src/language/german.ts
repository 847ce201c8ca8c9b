/** All words of the page in German. */

import type { Blocker, MoveReason, Whereabouts } from "./arguments";
import type { Catalogue } from "./english";
import { key, type Phrase, partsOf } from "./phrase";
import { speechOf } from "./speech";

const { say, plural, metres, centimetres, seconds, milliseconds, span, moment } = speechOf("de");

const SIDES = {
  ahead: "vor dir",
  aheadLeft: "links vor dir",
  left: "links",
  behindLeft: "links hinter dir",
  behind: "hinter dir",
  behindRight: "rechts hinter dir",
  right: "rechts",
  aheadRight: "rechts vor dir",
};
const FLOORS = { same: "", above: ", weiter oben", below: ", weiter unten" };
const APPROACHES = { nearer: ", kommt näher", further: ", geht weg" };

const MOVED: Record<MoveReason, string> = {
  inside_wall: "Diese Stelle liegt in einer Wand oder in etwas Festem",
  near_wall: "Diese Stelle liegt zu nah an einer Wand oder Kante",
  no_ground: "An dieser Stelle ist kein Boden",
  other_region: "Zu dieser Stelle führt kein Weg",
};

function people(count: number): Phrase {
  return plural(count, { one: say`${count} Person`, other: say`${count} Personen` });
}

function actors(count: number): Phrase {
  return plural(count, { one: say`${count} Akteur`, other: say`${count} Akteure` });
}

function near(count: number): Phrase {
  return plural(count, {
    one: say`${count} Person in der Nähe`,
    other: say`${count} Personen in der Nähe`,
  });
}

function where({ distanceM, side, floor, away, approach }: Whereabouts): Phrase {
  const aside = `, ${SIDES[side]}${FLOORS[floor]}${away ? ", gerade nicht am Bildschirm" : ""}`;
  return [...metres(distanceM), aside, approach === null ? "" : APPROACHES[approach]];
}

/** Whoever holds an actor: as the subject of a sentence, and as its object. */
function subject(who: Blocker): Phrase {
  switch (who.kind) {
    case "unseen":
      return say`jemand außer Sicht`;
    case "somebody":
      return say`jemand`;
    case "route":
      return say`ein Weg, der noch gesucht wird,`;
    default:
      return object(who);
  }
}

function object(whom: Blocker): Phrase {
  switch (whom.kind) {
    case "named":
      return say`${whom.name}`;
    case "door":
      return say`die Tür „${whom.name}“`;
    case "unnamedDoor":
      return say`eine Tür`;
    case "unseen":
      return say`jemanden außer Sicht`;
    case "somebody":
      return say`jemanden`;
    case "wall":
      return say`eine Wand`;
    case "route":
      return say`einen Weg, der noch gesucht wird`;
    case "something":
      return say`etwas`;
  }
}

export const german: Catalogue = {
  language: "Sprache",
  close: "Schließen",
  picture:
    "Die Welt. Gehe mit W A S D oder den Pfeiltasten; klicke auf den Boden, um dorthin zu gehen.",
  noConnection: "Nicht gesendet: Es besteht gerade keine Verbindung.",
  tooLong: (over, most) => say`Das sind ${over} Zeichen zu viel; höchstens ${most} sind möglich.`,

  status: {
    idle: "Nicht verbunden",
    connecting: "Verbindet …",
    live: "Verbunden",
    reconnecting: "Verbindet neu …",
    refused: "Draußen",
    roundTrip: milliseconds,
    comingBack: (why) => say`${partsOf(why)} Es geht von selbst weiter …`,
  },

  bar: {
    panels: "Bereiche",
    people: "Leute",
    plans: "Pläne",
    help: "Hilfe",
    share: "Teilen",
    shareHint: "Ein Link zu der Stelle, an der du bist",
    leave: "Gehen",
  },

  door: {
    what: "Ein Ort, an dem Menschen und vom Computer gesteuerte Akteure einander begegnen.",
    flat: "Dieser Browser zeichnet hier nicht in 3D, darum siehst du eine Karte. Alles andere ist wie bei allen.",
    name: "Dein Name",
    password: "Das Passwort dieses Ortes",
    look: "Aussehen wählen",
    comeIn: "Eintreten",
    comingIn: "Einen Moment …",
    noName: "Bitte gib einen Namen ein, den man sehen kann.",
    noPassword: "Bitte gib das Passwort ein.",
    tryingAgain: (why) => say`${partsOf(why)} Neuer Versuch …`,
    left: "Du bist gegangen. Komm wieder, wann immer du magst.",
  },

  look: {
    title: "Dein Aussehen",
    figure: "Du, wie andere dich sehen",
    surprise: "Überrasche mich",
    stature: "Größe",
    centimetres,
    wear: "So aussehen",
    stay: "So bleiben",
    parts: {
      shirt: "Hemd",
      trousers: "Hose",
      hair: "Frisur",
      hairColour: "Haarfarbe",
      skin: "Haut",
    },
    shirts: {
      red: "Rot",
      blue: "Blau",
      amber: "Bernstein",
      green: "Grün",
      violet: "Violett",
      linen: "Leinen",
      slate: "Schiefer",
      rose: "Rosa",
      teal: "Petrol",
      brown: "Braun",
      black: "Schwarz",
      lime: "Limette",
    },
    trousers: {
      ink: "Tinte",
      greyBlue: "Graublau",
      khaki: "Khaki",
      navy: "Marineblau",
      grey: "Grau",
      stone: "Stein",
      rust: "Rost",
      cream: "Creme",
    },
    hairdos: { short: "kurz", long: "lang", bun: "Dutt", curls: "Locken", shaven: "rasiert" },
    hairColours: {
      darkBrown: "Dunkelbraun",
      brown: "Braun",
      chestnut: "Kastanie",
      blond: "Blond",
      grey: "Grau",
      black: "Schwarz",
      red: "Rot",
      white: "Weiß",
    },
    skins: {
      skin1: "1, die hellste",
      skin2: "2",
      skin3: "3",
      skin4: "4",
      skin5: "5",
      skin6: "6",
      skin7: "7",
      skin8: "8, die dunkelste",
    },
  },

  people: {
    inView: "In Sicht",
    find: "Namen suchen",
    findHint: "Namen suchen …",
    people: "Menschen",
    actors: "Akteure",
    showPlan: "Plan zeigen",
    you: "du",
    away: "abwesend",
    muted: "stumm",
    awayAndMuted: "abwesend, stumm",
    inWorld: (personCount, actorCount) =>
      say`${people(personCount)} und ${actors(actorCount)} in der Welt`,
  },

  card: {
    where,
    find: "Finden",
    follow: "Folgen",
    wave: "Winken",
    share: "Teilen",
    mute: "Für mich stumm",
    unmute: "Wieder hören",
    reportMore: "Melden …",
    report: "Melden",
    tell: "Sag es denen, die auf diesen Ort achten",
    whys: {
      rude: "ist grob oder droht",
      unfit: "sagt, was nicht hierher gehört",
      inTheWay: "stellt sich mit Absicht in den Weg",
      pretends: "gibt sich für jemand anderen aus",
      other: "etwas anderes",
    },
    line: "Zu einer Zeile",
    noLine: "zu keiner Zeile",
    words: "In deinen Worten",
    sending: "Wird gesendet …",
  },

  following: {
    whom: (name) => say`Du folgst ${name}.`,
    end: "Nicht mehr folgen",
  },

  links: {
    toPlace: "Der Link führt zu einer Stelle hier.",
    toPerson: (name) => say`Der Link führt zu ${name}. Die Person ist hier.`,
    walk: "Hingehen",
    follow: "Folgen",
    stay: "Bleiben",
    copied: "Der Link ist kopiert.",
    copy: "Kopiere diesen Link:",
  },

  map: {
    map: "Karte des Ortes, Norden ist oben",
    floors: "Stockwerk, das die Karte zeigt",
    floor: (storey) => (storey === 0 ? say`Erdgeschoss` : say`${storey}. Obergeschoss`),
    sign: (storey) => (storey === 0 ? say`EG` : say`${storey}`),
  },

  plan: {
    panel: "Plan eines Akteurs",
    none: "Kein Akteur gewählt",
    choose: "Klicke auf einen Akteur oder wähle einen unter „Leute“.",
    awaited: "…",
    follow: "Folgen",
    followNoMore: "Nicht mehr folgen",
    joinTour: "Führung mitmachen",
    leaveTour: "Führung verlassen",
    stops: "Stationen der Führung",
    stop: (number) => say`Station ${number}`,
    led: (others) =>
      others === 0
        ? say`Du machst diese Führung mit.`
        : say`Du machst diese Führung mit, und mit dir ${people(others)}.`,
    others: (count) =>
      count === 0
        ? say`Noch macht niemand diese Führung mit.`
        : say`${people(count)} bei dieser Führung.`,
    path: "Weg, ein Punkt je Sekunde",
    soon: "wo bald Menschen sein können",
    late: "und wo später",
    behaviours: {
      go_to: (place) =>
        place === null ? say`geht zu einem Ort` : say`geht zu einem Ort, jetzt zu: ${place}`,
      wander: (place) =>
        place === null
          ? say`schlendert von Ort zu Ort`
          : say`schlendert von Ort zu Ort, jetzt zu: ${place}`,
      patrol: (place) =>
        place === null ? say`macht die Runde` : say`macht die Runde, jetzt zu: ${place}`,
      guide: (place) =>
        place === null ? say`leitet eine Führung` : say`leitet eine Führung, jetzt zu: ${place}`,
      idle: (place) =>
        place === null ? say`hat nichts zu tun` : say`hat nichts zu tun, jetzt zu: ${place}`,
    },
    unknown: (behaviour, place) =>
      place === null ? say`${behaviour}` : say`${behaviour}, jetzt zu: ${place}`,
    asNear: (who) => say`ist so nah am Ziel, wie es geht: ${subject(who)} ist dort`,
    blocked: (who) => say`hat aufgegeben: ${subject(who)} ist im Weg`,
    noWay: "hat aufgegeben: Kein Weg führt zum Ziel",
    moving: "folgt dem eigenen Weg",
    givingWay: (to) => say`macht Platz für ${object(to)}`,
    waiting: "wartet",
    waitingFor: (whom) => say`wartet auf ${object(whom)}`,
    replanning: "sucht einen anderen Weg",
    noPath: "findet keinen Weg zum Ziel",
    arrived: "ist angekommen",
    noReason: "kein Grund genannt",
    outlook: (reach, count) => {
      switch (reach.path) {
        case "toGoal":
          return say`in ${seconds(reach.seconds)} dort, ${near(count)}`;
        case "part":
          return say`Weg für ${seconds(reach.seconds)}, ${near(count)}`;
        case "none":
          return say`kein Weg, ${near(count)}`;
        case "over":
          return near(count);
      }
    },
  },

  chat: {
    chat: "Chat",
    said: "Was gesagt wurde",
    say: "Etwas sagen",
    hint: "Etwas sagen …",
    send: "Sagen",
    welcome: (name) => say`Willkommen, ${name}. Unter „Hilfe“ steht, wie man sich bewegt.`,
    welcomeBack: (name) => say`Willkommen zurück, ${name}.`,
    arrived: (scene) => say`Du bist jetzt hier: ${scene}.`,
    noBuilding: (fault) => say`Das Gebäude lässt sich nicht zeigen: ${fault}.`,
  },

  around: {
    somebody: (name, there) => say`${name}, ${where(there)}.`,
    place: (name, { distanceM, side }) =>
      say`Der Ort ${name}, ${metres(distanceM)}, ${[SIDES[side]]}.`,
    more: (count) => say`${count} weitere sind weiter weg.`,
    nobody: "Niemand ist in der Nähe.",
    together: (sentences) => sentences.flatMap((each, i) => [i === 0 ? "" : " ", ...partsOf(each)]),
  },

  stick: "Steuerknüppel zum Gehen: mit dem Daumen ziehen",

  gestures: {
    title: "Gesten",
    look: "Dein Aussehen …",
    names: {
      wave: "Winken",
      nod: "Nicken",
      point: "Zeigen",
      clap: "Klatschen",
      dance: "Tanzen",
      raise_hand: "Hand heben",
    },
    labels: {
      wave: "winkt",
      nod: "nickt",
      point: "zeigt auf etwas",
      clap: "klatscht",
      dance: "tanzt",
      raise_hand: "hebt die Hand",
    },
    they: {
      wave: (name) => say`${name} winkt.`,
      nod: (name) => say`${name} nickt.`,
      point: (name) => say`${name} zeigt auf etwas.`,
      clap: (name) => say`${name} klatscht.`,
      dance: (name) => say`${name} tanzt.`,
      raise_hand: (name) => say`${name} hebt die Hand.`,
    },
    you: {
      wave: "Du winkst.",
      nod: "Du nickst.",
      point: "Du zeigst auf etwas.",
      clap: "Du klatschst.",
      dance: "Du tanzt.",
      raise_hand: "Du hebst die Hand.",
    },
  },

  help: {
    title: "Wie man sich bewegt",
    walk: say`${key("W")} ${key("A")} ${key("S")} ${key("D")} oder Pfeile`,
    walkDoes: say`gehen, mit ${key("Q")} und ${key("E")} drehen, mit ${key("Umschalt")} laufen`,
    ground: "Auf den Boden klicken oder tippen",
    groundDoes: "dorthin gehen, um alles herum, was im Weg ist",
    drag: "Ziehen",
    dragDoes: "sich umsehen; mit dem Rad oder zwei Fingern kommt man näher",
    talk: say`${key("Eingabe")}`,
    talkDoes: say`mit denen in der Nähe sprechen; ${key("Esc")} verlässt die Zeile`,
    actor: "Auf einen Akteur klicken",
    actorDoes:
      "seinen Weg sehen, seinen Grund und wo er Menschen erwartet; ihm folgen oder eine Führung mitmachen",
    person: "Auf eine Person klicken",
    personDoes:
      "sie finden, ihr folgen, sie grüßen, stummschalten oder melden; in der Liste der Leute geht es auch",
    gestures: say`${key("1")} bis ${key("6")}`,
    gesturesDo: say`winken, nicken, zeigen, klatschen, tanzen, die Hand heben; ${key("G")} öffnet das Menü dazu, wo du auch dein Aussehen änderst`,
    around: say`${key("L")}`,
    aroundDoes: "im Chat steht dann, wer und was um dich herum ist",
    map: "Auf die Karte klicken",
    mapDoes: "dorthin gehen oder wählen, wen du angeklickt hast",
    floors: "Stockwerke unter der Karte",
    floorsDo: "ein anderes Stockwerk ansehen; was im Bild über dir ist, weicht von selbst",
    caps: "Wer eine grüne Kappe trägt, ist ein Akteur: Der Computer lässt ihn gehen.",
    drawing: "Zeichnung",
    automatic: "automatisch",
    fine: "fein",
    fast: "schnell",
    skeletons: "Fußabdrücke und Gelenke zeigen, und wonach Beine und Arme greifen",
    licences: "Lizenzen der Bibliotheken in dieser Seite",
  },

  notices: {
    announcement: "Durchsage",
    muted: (mutedS) => say`Du bist ${span(mutedS)} lang stummgeschaltet.`,
    mutedYet: (mutedS) => say`Du bist noch ${span(mutedS)} lang stummgeschaltet.`,
    unmuted: "Man hört dich wieder.",
    warned: "Die Moderation verwarnt dich.",
    walkedOut: "Du wirst zum Ausgang geführt.",
    reportTaken: "Danke.",
    reportRead: "Wer auf diesen Ort achtet, kann deine Meldung jetzt lesen.",
    notLetIn: "Du wirst dort gerade nicht eingelassen.",
    notLetInWhy: (why) => say`${why}.`,
    goalMoved: (why, movedM) =>
      say`${[MOVED[why]]}; du gehst zur nächstgelegenen, ${metres(movedM)} davon entfernt.`,
    paused:
      "Die Welt steht still: Die Leitung hat die Zeit kurz angehalten. Niemand bewegt sich, und du behältst deinen Platz. Reden kannst du weiter.",
    silent:
      "Dieser Ort antwortet gerade nicht. Niemand bewegt sich, und du behältst deinen Platz; gleich geht es von selbst weiter.",
    heard: "Es geht weiter.",
    resumed: "Die Welt läuft wieder wie sonst.",
    usual: "Die Zeit läuft wieder wie sonst.",
    slow: (factor) => say`Die Zeit läuft hier gerade langsam: ${factor}-mal so schnell wie sonst.`,
    quick: (factor) => say`Die Zeit läuft hier gerade schnell: ${factor}-mal so schnell wie sonst.`,
    behind: (factor, rate) =>
      say`Die Zeit soll ${factor}-mal so schnell laufen wie sonst, aber der Server schafft nur das ${rate}-Fache.`,
  },

  faults: {
    muted: (mutedS) =>
      say`Das hat niemand gehört: Du bist noch ${span(mutedS)} lang stummgeschaltet.`,
    slowMode: (waitS) =>
      say`Das hat niemand gehört: Hier spricht man langsam, warte also ${span(waitS)}.`,
    wordRefused: "Das hat niemand gehört: Darin ist ein Wort, das man hier nicht sagt.",
    quietZone: (zone) =>
      zone === null
        ? say`Das hat niemand gehört: Wo du stehst, ist es still.`
        : say`Das hat niemand gehört: Wo du stehst, ist es still (${zone}).`,
    noPath: "Dorthin führt kein Weg.",
    forbidden: "Nur die Leitung öffnet und schließt Türen.",
    leaseEnded: "Du bleibst stehen, weil von dieser Seite eine Weile nichts kam.",
    other: (text) => say`Der Server sagt: ${text}.`,
  },

  endings: {
    normal: "Der Server hat die Verbindung beendet.",
    goingAway: "Der Server macht eine kurze Pause.",
    tooLarge: "Diese Seite hat eine zu große Nachricht gesendet.",
    busy: "Der Ort antwortet gerade nicht.",
    unsupportedVersion: "Der Server spricht eine andere Version. Bitte lade diese Seite neu.",
    malformed: "Der Server konnte eine Nachricht von uns nicht lesen.",
    invalid: "Der Server hat abgelehnt, was diese Seite gesendet hat.",
    flooding: "Zu viele Nachrichten in zu kurzer Zeit.",
    helloExpected: "Der Server hat unsere Begrüßung nicht bekommen.",
    helloTimeout: "Unsere Begrüßung kam zu spät.",
    serverFull: "Der Ort ist voll. Bitte versuche es später noch einmal.",
    tooSlow: "Diese Verbindung ist zu langsam, um der Welt zu folgen.",
    replaced: "Dein Avatar ist in einem anderen Fenster weitergegangen. Dieses hier ruht.",
    silent: "Von dieser Seite kam eine Weile nichts.",
    nameReserved: "Diesen Namen kann man hier nicht haben.",
    admissionNeeded: "Hier kommt nicht jeder hinein: Man braucht eine Einladung.",
    passwordNeeded: "Hier kommt nicht jeder hinein: Man braucht eine Einladung oder das Passwort.",
    admissionRefused: "Du wurdest nicht eingelassen.",
    banned: "Du kannst hier nicht hinein.",
    kicked: "Die Leitung hat dich gebeten zu gehen.",
    lost: "Die Verbindung ist abgebrochen.",
    serverSilent: "Der Server schweigt.",
    noAnswer: "Der Server antwortet nicht.",
    unreadable: "Der Server hat etwas Unlesbares gesendet.",
  },
  endingSaid: (ending, said) => say`${[ending]} (${partsOf(said)})`,
  bannedUntil: (words, end) => say`${words} Nach dem ${moment(end)} kannst du wiederkommen.`,
  bannedForGood: (words) => say`${words} Ein Ende ist nicht festgelegt.`,
};
