// Where an answer is drawn: a picture with its tools, curves beside it, and the time below.
import { tag } from "./curves";
import type { Results } from "./data";
import type { Seen } from "./stage";

/** What is kept when the answer of a changed case takes the place of another. */
export interface Kept {
  /** Share of the duration at which it stands. */
  share: number;
  playing: boolean;
  factor?: number;
  rotating?: boolean;
  path?: boolean;
  /** Whether it is shown what joints transmit. */
  transmitted?: boolean;
  /** Where the picture is looked from. */
  seen?: Seen;
  mode?: number;
  /** Columns that are shown. */
  shown?: string[];
}

/** What a drawn answer lets others do with it. */
export interface Drawn {
  kept(): Kept;
  /** Draws it at a share of its duration. */
  seek(share: number): void;
  play(on: boolean): void;
  /** Draws another run in its place, if it has the same parts, times and columns; whether it has. */
  take?(results: Results, other?: Results): boolean;
  /** Seconds that playing takes. */
  seconds: number;
}

export class Room {
  readonly canvas = tag("canvas", { id: "canvas", role: "img", "aria-label": "The beam" });
  readonly options = tag("div", { id: "options", role: "toolbar", "aria-label": "View" });
  readonly scale = tag("div", { id: "scale" });
  readonly note = tag("p", { id: "note" });
  readonly curves = tag("section", { id: "curves", "aria-label": "Curves" });
  readonly play = tag("button", { id: "play", type: "button", "aria-label": "Play" });
  readonly scrubber = tag("input", { id: "scrubber", type: "range", min: "0", max: "1", step: "any", "aria-label": "Time" });
  readonly clock = tag("output", { id: "clock", for: "scrubber", "aria-live": "off" });
  readonly speed = tag("select", { id: "speed" });
  readonly measures = tag("div", { id: "measures", "aria-hidden": "true" }, this.scale);
  readonly stage = tag("section", { id: "stage", "aria-label": "Motion" }, this.canvas, this.options, this.measures, this.note);
  readonly footer = tag(
    "footer",
    { role: "group", "aria-label": "Playback" },
    this.play,
    this.scrubber,
    this.clock,
    tag("label", {}, tag("span", {}, "Speed"), this.speed),
  );
  private ending = new AbortController();

  constructor(readonly subtitle: HTMLElement) {}

  /** Ends when another answer takes the place of this one. */
  get signal(): AbortSignal {
    return this.ending.signal;
  }

  /** Takes away what is drawn. */
  clear() {
    this.ending.abort();
    this.ending = new AbortController();
    for (const node of [this.options, this.curves]) node.replaceChildren();
    this.measures.replaceChildren(this.scale);
    this.scale.textContent = "";
    this.curves.hidden = false;
    this.note.textContent = "";
  }
}
