// Values with their errors, as a table.
import { tag } from "./curves";
import type { Summary } from "./engine";
import { text } from "./text";

/** A value and its error with the digits that the error leaves. */
export function stated(value: number | null | undefined, error?: number | null): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (error === null || error === undefined || !Number.isFinite(error)) return text(value, 5);
  if (value === 0) return `0 ± ${text(error, 1)}`;
  if (error === 0) return `${text(value, 8)} ± 0`;
  const size = Math.abs(value);
  // No more than eight digits, however small the error.
  const power = Math.max(Math.floor(Math.log10(error)), size > 0 ? Math.floor(Math.log10(size)) - 7 : -12);
  const true_ = (written: string) => written.replace(/-/g, "−").replace("e+", "e");
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) {
    const digits = Math.min(Math.max(Math.floor(Math.log10(size)) - power, 0), 12);
    return `${true_(value.toExponential(digits))} ± ${true_(error.toExponential(0))}`;
  }
  const places = Math.min(Math.max(-power, 0), 12);
  const short = error < 1e-3 ? true_(error.toExponential(0)) : text(Number(error.toPrecision(1)), 1);
  return `${true_(value.toFixed(places))} ± ${short}`;
}

/** Value and error, between which a line may end. */
function parted(words: string): (Node | string)[] {
  const [value, error] = words.split(" ± ");
  return error === undefined ? [value] : [value, " ", tag("span", { class: "error" }, `± ${error}`)];
}

/** Least, greatest and last value of the columns of a run, the principal ones first. */
export function table(summary: Summary, other: Summary | undefined, signal: AbortSignal): HTMLElement {
  const columns = Object.entries(summary.columns ?? {});
  // Of one time there is one value.
  const shown: [string, "min" | "max" | "final"][] =
    summary.end_time === 0 ? [["value", "final"]] : [["least", "min"], ["greatest", "max"], ["at the end", "final"]];
  const rows = (which: (role?: string) => boolean) =>
    columns
      .filter(([, column]) => which(column.role))
      .map(([name, column]) => {
        const beside = other?.columns?.[name];
        const cells = shown.map(([, of]) => {
          const cell = tag("td", {}, ...parted(stated(column[of], column.error?.[of])));
          if (beside) cell.append(tag("span", { class: "beside" }, ...parted(stated(beside[of], beside.error?.[of]))));
          return cell;
        });
        const unit = column.unit ? tag("span", { class: "unit" }, column.unit) : "";
        return tag("tr", {}, tag("th", { scope: "row" }, name, " ", unit), ...cells);
      });
  const head = ["quantity", ...shown.map(([name]) => name)].map((name) => tag("th", { scope: "col" }, name));
  const body = tag("tbody", {}, ...rows((role) => role === "primary"));
  const whole = tag("table", { class: "values" }, tag("thead", {}, tag("tr", {}, ...head)), body);
  const further = rows((role) => role !== "primary");
  const more = tag("button", { type: "button" }, `All ${columns.length} quantities`);
  more.addEventListener("click", () => (body.append(...further), more.remove()), { signal });
  const caption = tag("p", { class: "caption" }, "± is the estimated error: of mesh and steps, found by finer runs.");
  return tag("div", { class: "table" }, whole, ...(further.length > 0 ? [more] : []), caption);
}
