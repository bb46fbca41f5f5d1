// What can be taken along: picture, film, files, and the case as link, text, command or Python.
import { tag } from "./curves";
import { quantity } from "./form";
import type { Drawn, Room } from "./room";

export function download(content: Blob, name: string) {
  const address = URL.createObjectURL(content);
  const link = Object.assign(document.createElement("a"), { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** Puts text into the clipboard. */
export async function copy(text: string, what: string) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const box = tag("textarea", { "aria-label": what });
    box.value = text;
    document.body.append(box);
    box.select();
    document.execCommand("copy");
    box.remove();
  }
}

/** The picture on the colour of the page. */
export async function picture({ canvas, stage }: Room): Promise<Blob> {
  if (stage.hidden) throw new Error("There is no picture here: print the page, or save all files.");
  const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height });
  const context = copy.getContext("2d")!;
  context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--paper").trim();
  context.fillRect(0, 0, copy.width, copy.height);
  context.drawImage(canvas, 0, 0);
  return new Promise((resolve, reject) => {
    copy.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("The picture could not be made."))), "image/png");
  });
}

/** Whether this browser makes films. */
export const films = () => typeof MediaRecorder !== "undefined" && "captureStream" in HTMLCanvasElement.prototype;

/** A film of the motion, once from its start to its end. */
export async function film({ canvas }: Room, drawn: Drawn, signal: AbortSignal): Promise<Blob> {
  const type = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find((type) => MediaRecorder.isTypeSupported(type));
  if (!type) throw new Error("This browser records no WebM.");
  const paper = Object.assign(document.createElement("canvas"), { width: canvas.width & ~1, height: canvas.height & ~1 });
  const context = paper.getContext("2d")!;
  const copy = () => {
    context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--paper").trim();
    context.fillRect(0, 0, paper.width, paper.height);
    context.drawImage(canvas, 0, 0);
  };
  drawn.play(false);
  drawn.seek(0);
  copy();
  const recorder = new MediaRecorder(paper.captureStream(30), { mimeType: type, videoBitsPerSecond: 6e6 });
  const parts: Blob[] = [];
  recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
  const ended = new Promise((resolve) => recorder.addEventListener("stop", resolve));
  recorder.start();
  const seconds = Math.min(Math.max(drawn.seconds, 1), 30);
  const start = performance.now();
  try {
    await new Promise<void>((resolve, reject) => {
      const next = () => {
        const share = (performance.now() - start) / 1000 / seconds;
        if (signal.aborted) return reject(new Error("The film has ended early: another answer took its place."));
        drawn.seek(Math.min(share, 1));
        copy();
        if (share >= 1) resolve();
        else requestAnimationFrame(next);
      };
      requestAnimationFrame(next);
    });
  } finally {
    recorder.stop();
  }
  await ended;
  return new Blob(parts, { type: "video/webm" });
}

/** Text within single quotes of a shell. */
const quoted = (text: string) => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`);

/** The command that computes the same. */
export function command(kind: string, path: string, changes: string[], speed: string | undefined, speeds: string): string {
  const options = changes.flatMap((change) => ["--set", quoted(change)]);
  const at = kind === "campbell" ? ["--speeds", quoted(speeds)] : kind === "modes" && speed ? ["--speed", quoted(speed)] : [];
  return ["flexion", kind, quoted(path), ...at, ...options].join(" ");
}

/** A text of Python that computes the same; `speeds` are those of a Campbell diagram, `from:to:number`. */
export function python(kind: string, toml: string, speed: string | undefined, speeds: string, files: string[]): string {
  const text = toml.includes('"""') || toml.includes("\\") ? JSON.stringify(toml) : `"""\n${toml.trimEnd()}\n"""`;
  const [, most, count] = speeds.split(":");
  const last = quantity(most) ?? { number: 10, unit: "" };
  const at = `${last.number} * k / ${Number(count) - 1}`;
  const diagram = last.unit ? `f"{${at}} ${last.unit}"` : at;
  const call = {
    run: 'case.run()\nprint(result)\nresult.plot().save("case.png")',
    modes: `case.modes(${JSON.stringify(speed ?? "0 rad/s")})\nprint(result)`,
    campbell: `case.campbell([${diagram} for k in range(${count})])\nprint(result)`,
    statics: "case.statics()\nprint(result)",
  }[kind];
  const beside = files.length > 0 ? `# The case reads ${files.join(", ")}: it is looked for from the folder in which this is called.\n` : "";
  return `import flexion\n\n${beside}case = flexion.Case(${text})\nresult = ${call}\n`;
}
