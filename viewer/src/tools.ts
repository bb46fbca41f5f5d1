// Buttons and lists above the picture.
import { tag } from "./curves";

const bar = () => document.getElementById("options")!;

/** A button that acts, also at the press of a key. */
export function button(label: string, key: string, act: () => void) {
  const made = tag("button", { type: "button", title: `${label} (${key})`, "aria-keyshortcuts": key }, label);
  made.addEventListener("click", act);
  onKey(key, act);
  bar().append(made);
}

/** A button that is on or off. */
export function toggle(label: string, key: string, on: boolean, act: (on: boolean) => void) {
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
  onKey(key, flip);
  bar().append(made);
}

/** A list of which one is chosen. */
export function choice<T>(label: string, entries: [string, T][], chosen: T, act: (value: T) => void) {
  const select = tag("select", {}, ...entries.map(([name], i) => new Option(name, String(i))));
  select.value = String(entries.findIndex(([, value]) => value === chosen));
  select.addEventListener("change", () => act(entries[Number(select.value)][1]));
  bar().append(tag("label", {}, tag("span", {}, label), select));
}

function onKey(key: string, act: () => void) {
  document.addEventListener("keydown", (event) => {
    const taken = event.ctrlKey || event.metaKey || event.altKey || (event.target as HTMLElement).matches("select");
    if (!taken && event.key.toLowerCase() === key) act();
  });
}
