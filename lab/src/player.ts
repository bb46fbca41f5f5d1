// Time: playing, stepping, the scrubber and the keys.
import type { Room } from "./room";
import { text } from "./text";

/** What takes keys itself. */
export const TYPED = "input:not([type=checkbox], [type=radio], [type=button]), textarea, dialog *";

export class Player {
  time: number;
  private playing = false;
  private last = 0;
  private readonly button: HTMLButtonElement;
  private readonly scrubber: HTMLInputElement;
  private readonly clock: HTMLOutputElement;
  private readonly select: HTMLSelectElement;

  /** From the first to the last of the times; `label` says the time, `show` draws it. */
  constructor(
    { play, scrubber, clock, speed: select, signal }: Room,
    private readonly times: Float64Array,
    private readonly label: (time: number) => string,
    private readonly show: (time: number) => void,
    private speed: number,
    kept?: { share: number; playing: boolean },
  ) {
    [this.button, this.scrubber, this.clock, this.select] = [play, scrubber, clock, select];
    const [start, end] = [times[0], times[times.length - 1]];
    this.time = start + (kept?.share ?? 0) * (end - start);
    [this.scrubber.min, this.scrubber.max] = [String(start), String(end)];
    this.offer();
    this.button.addEventListener("click", () => this.play(!this.playing), { signal });
    const scrubbed = () => {
      this.play(false);
      this.seek(Number(this.scrubber.value));
    };
    this.scrubber.addEventListener("input", scrubbed, { signal });
    this.select.addEventListener("change", () => (this.speed = Number(this.select.value)), { signal });
    document.addEventListener("keydown", (event) => this.key(event), { signal });
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.play(times.length > 1 && (kept?.playing ?? !still));
    const tick = (now: number) => {
      if (signal.aborted) return;
      this.tick(now);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  /** What is kept for the next answer. */
  get kept() {
    const [start, end] = [this.times[0], this.times[this.times.length - 1]];
    return { share: end > start ? (this.time - start) / (end - start) : 0, playing: this.playing };
  }

  /** Seconds that playing takes. */
  get seconds() {
    return (this.times[this.times.length - 1] - this.times[0]) / this.speed;
  }

  seek(time: number) {
    const [start, end] = [this.times[0], this.times[this.times.length - 1]];
    this.time = Math.min(Math.max(time, start), end);
    this.scrubber.value = String(this.time);
    this.clock.value = this.label(this.time);
    this.scrubber.setAttribute("aria-valuetext", this.clock.value);
    this.show(this.time);
  }

  play(on: boolean) {
    this.playing = on;
    this.button.setAttribute("aria-label", on ? "Pause" : "Play");
    this.button.classList.toggle("playing", on);
  }

  /** One of the recorded times before or behind. */
  step(by: number) {
    this.play(false);
    const behind = this.times.findIndex((time) => time > this.time);
    const at = (behind < 0 ? this.times.length : behind) - 1;
    const exact = this.times[at] === this.time;
    const index = by < 0 && !exact ? at + by + 1 : at + by;
    this.seek(this.times[Math.min(Math.max(index, 0), this.times.length - 1)]);
  }

  private offer() {
    const steps = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
    const all = steps.includes(this.speed) ? steps : [...steps, this.speed].sort((a, b) => a - b);
    this.select.replaceChildren(...all.map((speed) => new Option(`${text(speed)} ×`, String(speed))));
    this.select.value = String(this.speed);
  }

  private key(event: KeyboardEvent) {
    const target = event.target as HTMLElement;
    const own = target.matches(event.key === " " ? "select, button, summary, a, [type=checkbox]" : "select, [type=radio]");
    const typed = target !== this.scrubber && target.matches(TYPED);
    if (own || typed || target.isContentEditable || event.ctrlKey || event.metaKey || event.altKey) return;
    const by = event.shiftKey ? 10 : 1;
    const actions: Record<string, () => void> = {
      " ": () => this.play(!this.playing),
      ArrowLeft: () => this.step(-by),
      ArrowRight: () => this.step(by),
      Home: () => this.seek(this.times[0]),
      End: () => this.seek(this.times[this.times.length - 1]),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  private tick(now: number) {
    const passed = Math.min((now - this.last) / 1000, 0.1);
    this.last = now;
    if (this.playing) {
      const [start, end] = [this.times[0], this.times[this.times.length - 1]];
      const time = this.time + passed * this.speed;
      this.seek(time > end ? start : time);
    }
  }
}
