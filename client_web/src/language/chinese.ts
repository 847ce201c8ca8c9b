/** All words of the page in Traditional Chinese, as it is written in Taiwan. */

import type { Blocker, MoveReason, Whereabouts } from "./arguments";
import type { Catalogue } from "./english";
import { key, type Phrase, partsOf } from "./phrase";
import { speechOf } from "./speech";

const { say, metres, centimetres, seconds, milliseconds, span, moment } = speechOf("zh-Hant-TW");

const SIDES = {
  ahead: "正前方",
  aheadLeft: "左前方",
  left: "左邊",
  behindLeft: "左後方",
  behind: "正後方",
  behindRight: "右後方",
  right: "右邊",
  aheadRight: "右前方",
};
const FLOORS = { same: "", above: "，在樓上", below: "，在樓下" };
const APPROACHES = { nearer: "，正在靠近", further: "，正在走遠" };

const MOVED: Record<MoveReason, string> = {
  inside_wall: "那個位置在牆壁或實心物體裡",
  near_wall: "那個位置太靠近牆壁或邊緣",
  no_ground: "那個位置沒有地板",
  other_region: "沒有路通往那個位置",
};

function where({ distanceM, side, floor, away, approach }: Whereabouts): Phrase {
  const aside = `，${SIDES[side]}${FLOORS[floor]}${away ? "，暫時離開螢幕" : ""}`;
  return [...metres(distanceM), aside, approach === null ? "" : APPROACHES[approach]];
}

function blocker(who: Blocker): Phrase {
  switch (who.kind) {
    case "named":
      return say`${who.name}`;
    case "door":
      return say`「${who.name}」這扇門`;
    case "unnamedDoor":
      return say`一扇門`;
    case "unseen":
      return say`視線外的某人`;
    case "somebody":
      return say`某人`;
    case "wall":
      return say`一面牆`;
    case "route":
      return say`尚在尋找的路線`;
    case "something":
      return say`某個東西`;
  }
}

export const chinese: Catalogue = {
  language: "語言",
  close: "關閉",
  picture: "世界畫面。用 W A S D 或方向鍵走動；點一下地面就會走過去。",
  noConnection: "未送出：目前沒有連線。",
  tooLong: (over, most) => say`多了 ${over} 個字；最多 ${most} 個字。`,

  status: {
    idle: "未連線",
    connecting: "連線中…",
    live: "已連線",
    reconnecting: "重新連線中…",
    refused: "在門外",
    roundTrip: milliseconds,
    comingBack: (why) => say`${partsOf(why)}正在自動恢復…`,
  },

  bar: {
    panels: "面板",
    people: "人物",
    plans: "計畫",
    help: "說明",
    share: "分享",
    shareHint: "通往你所在位置的連結",
    leave: "離開",
  },

  door: {
    what: "一個真人與電腦角色一同漫步的地方。",
    flat: "這個瀏覽器在此無法繪製 3D，所以畫面是一張地圖。其他功能都與大家相同。",
    name: "你的名字",
    password: "這個地方的密碼",
    look: "選擇你的外觀",
    comeIn: "進入",
    comingIn: "進入中…",
    noName: "請輸入一個看得見的名字。",
    noPassword: "請輸入密碼。",
    tryingAgain: (why) => say`${partsOf(why)}正在重試…`,
    left: "你已離開。歡迎隨時再來。",
  },

  look: {
    title: "你的外觀",
    figure: "別人眼中的你",
    surprise: "隨機搭配",
    stature: "身高",
    centimetres,
    wear: "套用外觀",
    stay: "維持原樣",
    parts: {
      shirt: "上衣",
      trousers: "褲子",
      hair: "髮型",
      hairColour: "髮色",
      skin: "膚色",
    },
    shirts: {
      red: "紅色",
      blue: "藍色",
      amber: "琥珀色",
      green: "綠色",
      violet: "紫色",
      linen: "亞麻色",
      slate: "石板灰",
      rose: "玫瑰色",
      teal: "藍綠色",
      brown: "棕色",
      black: "黑色",
      lime: "萊姆綠",
    },
    trousers: {
      ink: "墨色",
      greyBlue: "灰藍色",
      khaki: "卡其色",
      navy: "海軍藍",
      grey: "灰色",
      stone: "石色",
      rust: "鏽色",
      cream: "米白色",
    },
    hairdos: { short: "短髮", long: "長髮", bun: "髮髻", curls: "捲髮", shaven: "光頭" },
    hairColours: {
      darkBrown: "深棕色",
      brown: "棕色",
      chestnut: "栗色",
      blond: "金色",
      grey: "灰色",
      black: "黑色",
      red: "紅色",
      white: "白色",
    },
    skins: {
      skin1: "1，最淺",
      skin2: "2",
      skin3: "3",
      skin4: "4",
      skin5: "5",
      skin6: "6",
      skin7: "7",
      skin8: "8，最深",
    },
  },

  people: {
    inView: "視線範圍內",
    find: "搜尋名字",
    findHint: "搜尋名字…",
    people: "真人",
    actors: "角色",
    showPlan: "顯示計畫",
    you: "你",
    away: "暫離",
    muted: "已靜音",
    awayAndMuted: "暫離、已靜音",
    inWorld: (personCount, actorCount) =>
      say`世界裡共有 ${personCount} 位真人與 ${actorCount} 個角色`,
  },

  card: {
    where,
    find: "尋找",
    follow: "跟隨",
    wave: "揮手",
    share: "分享",
    mute: "對我靜音",
    unmute: "取消靜音",
    reportMore: "檢舉…",
    report: "檢舉",
    tell: "告訴管理這個地方的人",
    whys: {
      rude: "無禮或威脅他人",
      unfit: "說了不適合這裡的話",
      inTheWay: "故意擋路",
      pretends: "冒充他人",
      other: "其他",
    },
    line: "關於哪一句話",
    noLine: "與發言無關",
    words: "用你的話說明",
    sending: "傳送中…",
  },

  following: {
    whom: (name) => say`你正在跟隨 ${name}。`,
    end: "停止跟隨",
  },

  links: {
    toPlace: "這個連結通往這裡的一個位置。",
    toPerson: (name) => say`這個連結通往 ${name}，對方就在這裡。`,
    walk: "走過去",
    follow: "跟隨",
    stay: "留在這裡",
    copied: "連結已複製。",
    copy: "請複製這個連結：",
  },

  map: {
    map: "這個地方的地圖，上方為北",
    floors: "地圖顯示的樓層",
    floor: (storey) => say`${storey + 1} 樓`,
    sign: (storey) => say`${storey + 1}F`,
  },

  plan: {
    panel: "角色的計畫",
    none: "尚未選擇角色",
    choose: "點一個角色，或在「人物」中選擇。",
    awaited: "…",
    follow: "跟隨",
    followNoMore: "停止跟隨",
    joinTour: "參加導覽",
    leaveTour: "離開導覽",
    stops: "導覽的各站",
    stop: (number) => say`第 ${number} 站`,
    led: (others) =>
      others === 0 ? say`你正在參加這場導覽。` : say`你與另外 ${others} 人正在參加這場導覽。`,
    others: (count) =>
      count === 0 ? say`還沒有人參加這場導覽。` : say`有 ${count} 人參加這場導覽。`,
    path: "路線，每秒一點",
    soon: "人們不久後可能的位置",
    late: "以及更晚的位置",
    behaviours: {
      go_to: (place) => (place === null ? say`前往某處` : say`前往某處，現在往：${place}`),
      wander: (place) => (place === null ? say`四處閒逛` : say`四處閒逛，現在往：${place}`),
      patrol: (place) => (place === null ? say`巡邏中` : say`巡邏中，現在往：${place}`),
      guide: (place) => (place === null ? say`帶領導覽` : say`帶領導覽，現在往：${place}`),
      idle: (place) => (place === null ? say`無事可做` : say`無事可做，現在往：${place}`),
    },
    unknown: (behaviour, place) =>
      place === null ? say`${behaviour}` : say`${behaviour}，現在往：${place}`,
    asNear: (who) => say`已盡可能靠近目的地：${blocker(who)}在那裡`,
    blocked: (who) => say`已放棄：${blocker(who)}擋住去路`,
    noWay: "已放棄：沒有路通往目的地",
    moving: "沿著路線前進",
    givingWay: (to) => say`正在讓路給${blocker(to)}`,
    waiting: "等待中",
    waitingFor: (whom) => say`正在等待${blocker(whom)}`,
    replanning: "正在找別的路",
    noPath: "找不到通往目的地的路",
    arrived: "已到達",
    noReason: "沒有說明原因",
    outlook: (reach, count) => {
      switch (reach.path) {
        case "toGoal":
          return say`${seconds(reach.seconds)}後到達，附近有 ${count} 人`;
        case "part":
          return say`路線還有 ${seconds(reach.seconds)}，附近有 ${count} 人`;
        case "none":
          return say`沒有路線，附近有 ${count} 人`;
        case "over":
          return say`附近有 ${count} 人`;
      }
    },
  },

  chat: {
    chat: "聊天",
    said: "大家說的話",
    say: "說句話",
    hint: "說句話…",
    send: "送出",
    welcome: (name) => say`歡迎，${name}。走動方式請見「說明」。`,
    welcomeBack: (name) => say`歡迎回來，${name}。`,
    arrived: (scene) => say`你來到了 ${scene}。`,
    noBuilding: (fault) => say`無法顯示建築物：${fault}。`,
  },

  around: {
    somebody: (name, there) => say`${name}，${where(there)}。`,
    place: (name, { distanceM, side }) =>
      say`地點 ${name}，${metres(distanceM)}，${[SIDES[side]]}。`,
    more: (count) => say`更遠處還有 ${count} 人。`,
    nobody: "附近沒有人。",
    together: (sentences) => sentences.flatMap(partsOf),
  },

  stick: "行走搖桿：用拇指拖曳",

  gestures: {
    title: "動作",
    look: "你的外觀…",
    names: {
      wave: "揮手",
      nod: "點頭",
      point: "指",
      clap: "拍手",
      dance: "跳舞",
      raise_hand: "舉手",
    },
    labels: {
      wave: "揮手",
      nod: "點頭",
      point: "指向前方",
      clap: "拍手",
      dance: "跳舞",
      raise_hand: "舉手",
    },
    they: {
      wave: (name) => say`${name} 在揮手。`,
      nod: (name) => say`${name} 在點頭。`,
      point: (name) => say`${name} 指向前方。`,
      clap: (name) => say`${name} 在拍手。`,
      dance: (name) => say`${name} 在跳舞。`,
      raise_hand: (name) => say`${name} 舉起手。`,
    },
    you: {
      wave: "你在揮手。",
      nod: "你在點頭。",
      point: "你指向前方。",
      clap: "你在拍手。",
      dance: "你在跳舞。",
      raise_hand: "你舉起手。",
    },
  },

  help: {
    title: "如何走動",
    walk: say`${key("W")} ${key("A")} ${key("S")} ${key("D")} 或方向鍵`,
    walkDoes: say`走路，用 ${key("Q")} 與 ${key("E")} 轉向，按住 ${key("Shift")} 跑步`,
    ground: "點按地面",
    groundDoes: "走到那裡，並繞過擋路的東西",
    drag: "拖曳",
    dragDoes: "環顧四周；用滾輪或雙指可拉近",
    talk: say`${key("Enter")}`,
    talkDoes: say`與附近的人說話；按 ${key("Esc")} 離開輸入列`,
    actor: "點一個角色",
    actorDoes: "看它的路線、原因，以及它預期人們會在哪裡；跟隨它，或參加導覽員的導覽",
    person: "點一個人",
    personDoes: "尋找、跟隨、打招呼、靜音或檢舉；人物清單裡也有相同功能",
    gestures: say`${key("1")} 到 ${key("6")}`,
    gesturesDo: say`揮手、點頭、指、拍手、跳舞、舉手；${key("G")} 開啟動作選單，也可在那裡更換外觀`,
    around: say`${key("L")}`,
    aroundDoes: "在聊天中說出你周圍有誰、有什麼",
    map: "點地圖",
    mapDoes: "走到那裡，或選擇你點的人",
    floors: "地圖下方的樓層",
    floorsDo: "查看其他樓層；畫面中在你上方的東西會自動讓開",
    caps: "戴綠帽的是角色：由電腦控制行走。",
    drawing: "繪圖",
    automatic: "自動",
    fine: "精細",
    fast: "快速",
    skeletons: "顯示腳印、關節，以及手腳的目標",
    licences: "本頁所用程式庫的授權條款",
  },

  notices: {
    announcement: "公告",
    muted: (mutedS) => say`你已被禁言 ${span(mutedS)}。`,
    mutedYet: (mutedS) => say`你還要被禁言 ${span(mutedS)}。`,
    unmuted: "大家又聽得到你了。",
    warned: "管理員對你提出警告。",
    walkedOut: "正帶你走向出口。",
    reportTaken: "謝謝你。",
    reportRead: "管理這個地方的人現在可以看到你的檢舉。",
    notLetIn: "目前無法讓你進入那裡。",
    notLetInWhy: (why) => say`${why}。`,
    goalMoved: (why, movedM) => say`${[MOVED[why]]}；改走到最近的位置，相距 ${metres(movedM)}。`,
    paused: "世界已暫停：管理員暫時停住了時間。沒有人會移動，你的位置也會保留。你可以繼續聊天。",
    silent: "這個地方暫時沒有回應。沒有人會移動，你的位置也會保留；稍後會自動恢復。",
    heard: "這個地方恢復了。",
    resumed: "世界恢復正常運行。",
    usual: "時間恢復正常速度。",
    slow: (factor) => say`這裡的時間目前變慢：是平常速度的 ${factor} 倍。`,
    quick: (factor) => say`這裡的時間目前變快：是平常速度的 ${factor} 倍。`,
    behind: (factor, rate) =>
      say`時間應以平常的 ${factor} 倍速度進行，但伺服器只能達到 ${rate} 倍。`,
  },

  faults: {
    muted: (mutedS) => say`沒有人聽到：你還要被禁言 ${span(mutedS)}。`,
    slowMode: (waitS) => say`沒有人聽到：這裡是慢速模式，請等待 ${span(waitS)}。`,
    wordRefused: "沒有人聽到：其中有這裡不能說的詞。",
    quietZone: (zone) =>
      zone === null
        ? say`沒有人聽到：你站的地方需要安靜。`
        : say`沒有人聽到：你站的地方需要安靜（${zone}）。`,
    noPath: "沒有路通往那裡。",
    forbidden: "只有管理員能開關門。",
    leaseEnded: "你停下來了，因為這個頁面有一陣子沒有送出任何訊息。",
    other: (text) => say`伺服器說：${text}。`,
  },

  endings: {
    normal: "伺服器結束了連線。",
    goingAway: "伺服器暫時關閉。",
    tooLarge: "這個頁面送出的訊息太大。",
    busy: "這個地方暫時沒有回應。",
    unsupportedVersion: "伺服器使用不同的版本。請重新載入這個頁面。",
    malformed: "伺服器讀不懂我們的一則訊息。",
    invalid: "伺服器拒絕了這個頁面送出的內容。",
    flooding: "短時間內訊息太多。",
    helloExpected: "伺服器沒有收到我們的問候。",
    helloTimeout: "我們的問候太晚送達。",
    serverFull: "這個地方已客滿。請稍後再試。",
    tooSlow: "這個連線太慢，跟不上世界。",
    replaced: "你的分身在另一個視窗繼續了。這個視窗已停止。",
    silent: "這個頁面有一陣子沒有送出任何訊息。",
    nameReserved: "這裡不能使用這個名字。",
    admissionNeeded: "這裡並非人人都能進入：需要邀請。",
    passwordNeeded: "這裡並非人人都能進入：需要邀請或密碼。",
    admissionRefused: "你未獲准進入。",
    banned: "你不能進入這裡。",
    kicked: "管理員請你離開。",
    lost: "連線中斷了。",
    serverSilent: "伺服器沒有回應了。",
    noAnswer: "伺服器沒有回應。",
    unreadable: "伺服器送來了無法讀取的內容。",
  },
  endingSaid: (ending, said) => say`${[ending]}（${partsOf(said)}）`,
  bannedUntil: (words, end) => say`${words}你可以在 ${moment(end)} 之後回來。`,
  bannedForGood: (words) => say`${words}沒有設定結束時間。`,
};
