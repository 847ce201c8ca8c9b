/** The time that a piece of every frame's work takes: a running mean over about a second. */
export class Cost {
  ms = 0;

  of(work: () => void): void {
    const beganMs = performance.now();
    work();
    this.ms += (performance.now() - beganMs - this.ms) / 30;
  }
}
