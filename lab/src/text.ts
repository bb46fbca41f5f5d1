// Numbers as text.

/** The largest of 1, 2 and 5 times a power of ten that is not above `x`. */
export function nice(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  return [5, 2, 1].map((step) => step * power).find((step) => step <= x * (1 + 1e-9)) ?? power;
}

/** A number with some digits, with a true minus. */
export function text(x: number, digits = 4): string {
  if (!Number.isFinite(x)) return "–";
  const [size, short] = [Math.abs(x), Number(x.toPrecision(digits))];
  const plain = size === 0 || (size >= 1e-3 && size < 1e5);
  return (plain ? String(short) : short.toExponential()).replace(/-/g, "−").replace("e+", "e");
}

/** A number with as many digits each time, so that it does not jump. */
export function steady(x: number): string {
  if (!Number.isFinite(x)) return "–";
  const size = Math.abs(x);
  const digits = size >= 1e5 || (size < 1e-3 && size > 0) ? x.toExponential(3) : x.toFixed(size >= 100 ? 1 : 4);
  return digits.replace(/-/g, "−").replace("e+", "e");
}

const PER_SECOND: Record<string, number> = { "rad/s": 1, rpm: Math.PI / 30, Hz: 2 * Math.PI };

/** How many rad/s a unit of speed or frequency is, of those that replies are in. */
export const inRadians = (unit: string) => PER_SECOND[unit] ?? 1;

/** At most so many intervals between round numbers within a range. */
export function ticks(low: number, high: number, count = 5): number[] {
  if (!(high > low)) return [low];
  const least = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(least));
  const step = [1, 2, 5, 10].map((by) => by * power).find((step) => step >= least * (1 - 1e-9)) ?? 10 * power;
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.min(last - first + 1, 100) }, (_, k) => Number(((first + k) * step).toPrecision(12)));
}

/** Numbers beside the lines of an axis: where they differ by little only, the first, and by how much the others are larger. */
export function labels(values: number[]): string[] {
  const most = Math.max(...values.map(Math.abs));
  const digits = values.length > 1 ? Math.ceil(Math.log10(most / (values[1] - values[0]))) + 1 : 6;
  if (!(digits > 8)) return values.map((value) => text(value, Math.max(digits, 6)));
  return values.map((value, k) => {
    if (k === 0) return text(value, Math.min(digits, 12));
    // Lines that rounding has made one have one number.
    return value > values[k - 1] ? `+${text(value - values[0], 3)}` : "";
  });
}
