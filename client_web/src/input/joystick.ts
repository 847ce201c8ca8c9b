/** The stick for thumbs. */

export class Joystick {
  /** Deflection to the right and forwards, each -1…1; null while nobody holds it. */
  value: { x: number; y: number } | null = null;

  constructor(
    private readonly base: HTMLElement,
    private readonly knob: HTMLElement,
  ) {
    base.addEventListener("pointerdown", (event) => {
      base.setPointerCapture(event.pointerId);
      this.hold(event);
    });
    base.addEventListener("pointermove", (event) => {
      if (this.value) this.hold(event);
    });
    for (const type of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      base.addEventListener(type, () => {
        this.release();
      });
    }
  }

  private hold(event: PointerEvent): void {
    const { left, top, width, height } = this.base.getBoundingClientRect();
    const x = ((event.clientX - left) / width) * 2 - 1;
    const y = 1 - ((event.clientY - top) / height) * 2;
    const length = Math.max(1, Math.hypot(x, y));
    this.value = { x: x / length, y: y / length };
    this.knob.style.transform = `translate(${(this.value.x * width) / 3}px, ${(-this.value.y * height) / 3}px)`;
  }

  private release(): void {
    this.value = null;
    this.knob.style.transform = "";
  }
}
