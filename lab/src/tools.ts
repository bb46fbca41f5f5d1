// Buttons and lists above the picture.
import { tag } from "./curves";
import { TYPED } from "./player";
import type { Room } from "./room";

/** A button that acts, also at the press of a key. */
export function button(room: Room, label: string, key: string, act: () => void) {
  const made = tag("button", { type: "button", title: `${label} (${key})`, "aria-keyshortcuts": key }, label);
  made.addEventListener("click", act);
  onKey(room, key, act);
  room.options.append(made);
}

/** A button that is on or off. */
export function toggle(room: Room, label: string, key: string, on: boolean, act: (on: boolean) => void) {
  const made = tag(
    "button",
    { type: "button", title: `${label} (${key})`, "aria-keyshortcuts": key, "aria-pressed": String(on) },
    label,
  );
  const flip = () => {
    const now = made.getAttribute("aria-pressed") !== "true";
    made.setAttribute("aria-pressed", String(now));
    act(now);
  };
  made.addEventListener("click", flip);
  onKey(room, key, flip);
  room.options.append(made);
}

/** A list of which one is chosen. */
export function choice<T>(room: Room, label: string, entries: [string, T][], chosen: T, act: (value: T) => void) {
  const select = tag("select", {}, ...entries.map(([name], i) => new Option(name, String(i))));
  select.value = String(entries.findIndex(([, value]) => value === chosen));
  select.addEventListener("change", () => act(entries[Number(select.value)][1]));
  room.options.append(tag("label", {}, tag("span", {}, label), select));
}

function onKey({ signal }: Room, key: string, act: () => void) {
  const pressed = (event: KeyboardEvent) => {
    const target = event.target as HTMLElement;
    const typed = target.matches(`select, ${TYPED}`) && !target.matches("[type=range]");
    const taken = event.ctrlKey || event.metaKey || event.altKey || typed || target.isContentEditable;
    if (!taken && event.key.toLowerCase() === key) act();
  };
  document.addEventListener("keydown", pressed, { signal });
}
