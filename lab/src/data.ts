// The results as they stand in the page.

type Encoded = string;

export interface Stored {
  shape: number[];
  values: Encoded;
}

interface Column {
  name: string;
  unit: string;
  shown: boolean;
  values: Encoded;
  /** Half the width of the band of its error at every time. */
  error?: Encoded | number | null;
}

export interface Vibration {
  frequency: number;
  "damping-ratio": number;
  nodes: number;
  shares: Record<string, number>;
}

export interface Results {
  title: string;
  name: string;
  version: string;
  caution?: string | null;
  scene: Record<string, Stored>;
  curves?: { times: Encoded; columns: Column[]; trusted?: number | null };
  modes?: {
    table: { unit: string; "speed-unit": string; speed: number; modes: Vibration[]; warnings: string[] };
    shapes: Record<string, Stored>;
  };
}

/** Numbers in base64, behind their kind. */
export function numbers(encoded: Encoded): Float64Array {
  const [kind, text] = encoded.split(":");
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
  return kind === "f4" ? Float64Array.from(new Float32Array(bytes.buffer)) : new Float64Array(bytes.buffer);
}

/** An array by its name, if it is there. */
export function array(of: Record<string, Stored>, name: string): Float64Array | undefined {
  return of[name] && numbers(of[name].values);
}

export function read(): Results {
  return JSON.parse(document.getElementById("results")!.textContent!);
}
