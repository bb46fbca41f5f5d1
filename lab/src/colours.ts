// Colours of the style sheet: light or dark as the system is, and light on paper.

const known = new Map<string, string>();
const others = new EventTarget();

/** A colour by its name. */
export function styled(name: string): string {
  const colour = known.get(name) ?? getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  known.set(name, colour);
  return colour;
}

/** Acts when colours have become others. */
export const recoloured = (act: () => void, signal: AbortSignal) => others.addEventListener("change", act, { signal });

function change() {
  known.clear();
  others.dispatchEvent(new Event("change"));
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", change);
// What is drawn is drawn anew before the page is laid out on paper, where the style sheet alone would come too late for it.
for (const [event, paper] of [["beforeprint", true], ["afterprint", false]] as const) {
  addEventListener(event, () => {
    document.documentElement.classList.toggle("paper", paper);
    change();
  });
}
