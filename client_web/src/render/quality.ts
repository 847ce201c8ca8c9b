/** The fineness of drawing: chosen by the duration of frames, or by the person. */

export interface Quality {
  /** Pixels drawn for one CSS pixel, at most. */
  pixelRatio: number;
  /** Shadows of figures, drawn anew every frame. */
  livingShadows: boolean;
  /** Shadows of what stands still, drawn once. */
  shadows: boolean;
  /** Figures nearer than this are fine. */
  fineFiguresM: number;
}

/** From fine to fast. */
export const LEVELS: readonly Quality[] = [
  { pixelRatio: 2, livingShadows: true, shadows: true, fineFiguresM: 24 },
  { pixelRatio: 1.25, livingShadows: false, shadows: true, fineFiguresM: 16 },
  { pixelRatio: 1, livingShadows: false, shadows: true, fineFiguresM: 14 },
  { pixelRatio: 0.75, livingShadows: false, shadows: false, fineFiguresM: 9 },
  { pixelRatio: 0.5, livingShadows: false, shadows: false, fineFiguresM: 6 },
];

const SOFTWARE_LEVEL = 3;

export type Choice = "automatic" | "fine" | "fast";

/** A window of frames is judged when it has this many, or a few that took long together. */
const WINDOW = 30;
const FEW = 4;
const LONG_S = 1;
const SLOW_S = 1 / 28;
/** Frames that are slower than this go down two levels at once. */
const VERY_SLOW_S = 1 / 10;
/** A longer pause says nothing of the drawing: the page was hidden. */
const PAUSE_S = 3;
const QUICK_S = 1 / 55;
/** Quick windows in a row before something finer is tried. */
const PATIENCE = 12;

/** It goes to a faster level after one slow window of frames, and back after many quick ones. */
export class QualityControl {
  level: number;
  private sumS = 0;
  private frames = 0;
  private quickWindows = 0;
  private patience = PATIENCE;

  /** `software`: there is no graphics card, so that it is better to begin with a fast level. */
  constructor(
    private readonly choice: Choice,
    software: boolean,
  ) {
    const first = software ? SOFTWARE_LEVEL : 0;
    this.level = { automatic: first, fine: 0, fast: LEVELS.length - 1 }[choice];
  }

  /** One frame took this long; true if the level changed. */
  frame(frameS: number): boolean {
    if (this.choice !== "automatic") return false;
    if (frameS > PAUSE_S) return false;
    this.sumS += frameS;
    this.frames++;
    if (this.frames < WINDOW && (this.frames < FEW || this.sumS < LONG_S)) return false;
    const mean = this.sumS / this.frames;
    this.sumS = this.frames = 0;
    this.quickWindows = mean < QUICK_S ? this.quickWindows + 1 : 0;
    if (mean > SLOW_S && this.level < LEVELS.length - 1) {
      this.level = Math.min(LEVELS.length - 1, this.level + (mean > VERY_SLOW_S ? 2 : 1));
      this.patience *= 2;
      return true;
    }
    if (this.quickWindows >= this.patience && this.level > 0) {
      this.level--;
      this.quickWindows = 0;
      return true;
    }
    return false;
  }

  get quality(): Quality {
    const quality = LEVELS[this.level];
    if (!quality) throw new RangeError(`there is no level ${this.level}`);
    return quality;
  }
}
