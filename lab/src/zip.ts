// An archive of files that are stored as they are.

/** The cyclic redundancy code of bytes, as zip has it. */
function code(bytes: Uint8Array): number {
  let code = ~0;
  for (const byte of bytes) {
    code ^= byte;
    for (let i = 0; i < 8; i++) code = (code >>> 1) ^ (code & 1 ? 0xedb88320 : 0);
  }
  return ~code >>> 0;
}

export function zip(files: Record<string, Uint8Array<ArrayBuffer>>): Blob {
  const [parts, listed]: [Uint8Array<ArrayBuffer>[], Uint8Array<ArrayBuffer>[]] = [[], []];
  let at = 0;
  const record = (numbers: [number, 2 | 4][], ...rest: Uint8Array[]) => {
    const size = numbers.reduce((sum, [, bytes]) => sum + bytes, 0);
    const out = new Uint8Array(size + rest.reduce((sum, part) => sum + part.length, 0));
    const view = new DataView(out.buffer);
    let place = 0;
    for (const [value, bytes] of numbers) {
      if (bytes === 2) view.setUint16(place, value, true);
      else view.setUint32(place, value, true);
      place += bytes;
    }
    for (const part of rest) {
      out.set(part, place);
      place += part.length;
    }
    return out;
  };
  for (const [path, content] of Object.entries(files)) {
    const name = new TextEncoder().encode(path);
    // Version 2.0, names in UTF-8, stored, 1 January 1980.
    const about: [number, 2 | 4][] = [[20, 2], [0x800, 2], [0, 2], [0, 2], [0x21, 2], [code(content), 4], [content.length, 4], [content.length, 4], [name.length, 2], [0, 2]];
    const local = record([[0x04034b50, 4], ...about], name, content);
    listed.push(record([[0x02014b50, 4], [20, 2], ...about, [0, 2], [0, 2], [0, 2], [0, 4], [at, 4]], name));
    parts.push(local);
    at += local.length;
  }
  const size = listed.reduce((sum, part) => sum + part.length, 0);
  const count = listed.length;
  const end = record([[0x06054b50, 4], [0, 2], [0, 2], [count, 2], [count, 2], [size, 4], [at, 4], [0, 2]]);
  return new Blob([...parts, ...listed, end], { type: "application/zip" });
}
