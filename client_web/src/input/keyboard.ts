/** Keys that walk and turn: where the person wants to go, seen from the camera. */

export interface Wish {
  /** 1 is away from the camera. */
  forward: number;
  /** 1 is to the right. */
  right: number;
  /** 1 turns the camera to the left. */
  turn: number;
  hurry: boolean;
}

const FORWARD = ["KeyW", "ArrowUp"];
const BACK = ["KeyS", "ArrowDown"];
const LEFT = ["KeyA", "ArrowLeft"];
const RIGHT = ["KeyD", "ArrowRight"];
const TURN_LEFT = ["KeyQ"];
const TURN_RIGHT = ["KeyE"];
const HURRY = ["ShiftLeft", "ShiftRight"];
const USED = new Set([
  ...FORWARD,
  ...BACK,
  ...LEFT,
  ...RIGHT,
  ...TURN_LEFT,
  ...TURN_RIGHT,
  ...HURRY,
]);

/** Keys by their place on the keyboard, so that WASD works on every layout. */
export class WalkKeys {
  private readonly held = new Set<string>();

  /** True if the key walks or turns. */
  press(code: string): boolean {
    if (!USED.has(code)) return false;
    this.held.add(code);
    return true;
  }

  release(code: string): void {
    this.held.delete(code);
  }

  releaseAll(): void {
    this.held.clear();
  }

  get wish(): Wish {
    const any = (codes: readonly string[]): number => (codes.some((c) => this.held.has(c)) ? 1 : 0);
    return {
      forward: any(FORWARD) - any(BACK),
      right: any(RIGHT) - any(LEFT),
      turn: any(TURN_LEFT) - any(TURN_RIGHT),
      hurry: any(HURRY) > 0,
    };
  }
}

/** Listen to the keys of a page, but not while somebody types or uses a control with arrows. */
export function listenToKeys(keys: WalkKeys, page: Window): void {
  page.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target)) return;
    if (keys.press(event.code)) event.preventDefault();
  });
  page.addEventListener("keyup", (event) => {
    keys.release(event.code);
  });
  page.addEventListener("blur", () => {
    keys.releaseAll();
  });
  page.addEventListener("focusin", (event) => {
    if (isTyping(event.target)) keys.releaseAll();
  });
}

/** Whether keys go to a control that takes them. */
export function isTyping(target: EventTarget | null): boolean {
  return target instanceof Element && target.closest("input, textarea, select, dialog") !== null;
}
