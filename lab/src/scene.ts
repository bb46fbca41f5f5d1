// What moves: parts with a pose at every time, beams with the displacements of their sections, obstacles with outlines.
import { Quaternion, Vector3 } from "three";
import { array, type Results } from "./data";

type Arrays = Results["scene"];

/** A part of the system. */
export interface Part {
  name: string;
  /** Seven numbers a time: position, quaternion (w, x, y, z). */
  poses: Float64Array;
  /** Of a beam. */
  beam?: Beam;
  /** Of a rigid body: centre and edges. */
  box?: Float64Array;
}

export interface Beam {
  stations: Float64Array;
  /** Three numbers a time and station. */
  displacements: Float64Array;
  rotations: Float64Array;
  section: Float64Array;
  /** Radius of the hub. */
  hub?: number;
  /** Whether it is straight where nothing deflects it. */
  straight: boolean;
}

/** A force or a couple. */
export interface Acting {
  name: string;
  values: Float64Array;
}

/** A force per length along a beam. */
export interface Along {
  name: string;
  /** Number of places. */
  points: number;
  /** Six numbers a time and place: the place and the force per length. */
  values: Float64Array;
}

/** Forces and couples of loads and contacts, and those that joints and springs transmit. */
export const KINDS = ["force", "moment", "transmitted-force", "transmitted-moment"];

export interface Scene {
  times: Float64Array;
  parts: Part[];
  /** Outlines: three numbers a time and point. */
  outlines: { name: string; points: Float64Array }[];
  /** By KINDS: six numbers a time, the place and the force or the couple. */
  acting: Acting[][];
  along: Along[];
  /** How many of the smallest of these are left out. */
  left: number;
  /** Whether all stays in the plane of the first two axes. */
  planar: boolean;
}

/** A place between two times: numbers of both, and the share of the second. */
export interface Instant {
  from: number;
  to: number;
  share: number;
}

/** A section of a beam: where it is and how it is turned. */
export interface Section {
  position: Vector3;
  turned: Quaternion;
}

/** The largest size of numbers. */
export function largest(values: ArrayLike<number>): number {
  let most = 0;
  for (let i = 0; i < values.length; i++) most = Math.max(most, Math.abs(values[i]));
  return most;
}

export function scene(arrays: Arrays): Scene {
  const get = (name: string) => array(arrays, name);
  const names = (suffix: string) =>
    Object.keys(arrays).flatMap((key) => (key.endsWith(suffix) ? [key.slice(0, -suffix.length)] : []));
  const parts = names(".pose").map((name): Part => {
    const stations = get(`${name}.station`);
    const displacements = get(`${name}.displacement`)!;
    const hub = get(`${name}.hub`)?.[0];
    const beam = stations && {
      stations,
      displacements,
      rotations: get(`${name}.rotation`)!,
      section: get(`${name}.section`)!,
      hub,
      straight: hub !== undefined || largest(displacements.subarray(0, 3 * stations.length)) < 1e-3 * stations.at(-1)!,
    };
    return { name, poses: get(`${name}.pose`)!, beam, box: get(`${name}.box`) };
  });
  const outlines = names(".outline").map((name) => ({ name, points: get(`${name}.outline`)! }));
  const flat = (part: Part) =>
    part.poses.every((x, i) => ![2, 4, 5].includes(i % 7) || Math.abs(x) < 1e-12) &&
    (part.beam?.displacements.every((x, i) => i % 3 !== 2 || x === 0) ?? false);
  const acting = KINDS.map((what) => names(`.${what}`).map((name): Acting => ({ name, values: get(`${name}.${what}`)! })));
  const along = names(".line-force").map((name): Along => ({ name, points: arrays[`${name}.line-force`].shape[1], values: get(`${name}.line-force`)! }));
  return { times: get("time")!, parts, outlines, acting, along, left: get("left-out")?.[0] ?? 0, planar: parts.every(flat) };
}

/** Where `time` lies among ascending times. */
export function instant(times: Float64Array, time: number): Instant {
  let [low, high] = [0, times.length - 1];
  while (low + 1 < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  const width = times[high] - times[low];
  const share = width > 0 ? Math.min(Math.max((time - times[low]) / width, 0), 1) : 0;
  return { from: low, to: high, share };
}

/** Points that a part extends to. */
export function extent(part: Part, at: Instant, factor: number): Vector3[] {
  if (part.beam) return sections(part, at, factor, 1).map((section) => section.position);
  const { position, turned } = pose(part, at);
  const [x, y, z, a, b, c] = part.box ?? new Float64Array(6);
  const corner = (i: number) => new Vector3(i & 1 ? a : -a, i & 2 ? b : -b, i & 4 ? c : -c).divideScalar(2);
  const corners = Array.from({ length: 8 }, (_, i) => corner(i).add(new Vector3(x, y, z)));
  return corners.map((point) => point.applyQuaternion(turned).add(position));
}

/** The rotation by a vector. */
export function rotation(theta: Vector3): Quaternion {
  const angle = theta.length();
  return angle > 0 ? new Quaternion().setFromAxisAngle(theta.clone().divideScalar(angle), angle) : new Quaternion();
}

/** The pose of a part. */
export function pose(part: Part, { from, to, share }: Instant): Section {
  const p = part.poses;
  const position = (i: number) => new Vector3(p[7 * i], p[7 * i + 1], p[7 * i + 2]);
  const turned = (i: number) => new Quaternion(p[7 * i + 4], p[7 * i + 5], p[7 * i + 6], p[7 * i + 3]);
  const result = { position: position(from), turned: turned(from).slerp(turned(to), share) };
  if (part.beam?.hub) {
    // About the axis of the hub, so that the root stays on its circle.
    const axis = (i: number) => position(i).sub(new Vector3(part.beam!.hub, 0, 0).applyQuaternion(turned(i)));
    const root = new Vector3(part.beam.hub, 0, 0).applyQuaternion(result.turned);
    result.position = axis(from).lerp(axis(to), share).add(root);
  } else {
    result.position.lerp(position(to), share);
  }
  return result;
}

/** Between two times, a point, or a vector if it is `free`, of both: in the frame in which it changes least, at rest or of a part. */
export function between(parts: Part[], at: Instant): (before: Vector3, after: Vector3, free: boolean) => Vector3 {
  const { from, to, share } = at;
  const ends = [from, to].map((k): Instant => ({ from: k, to: k, share: 0 }));
  const frames = share > 0 && share < 1 ? parts.map((part) => [...ends, at].map((time) => pose(part, time))) : [];
  return (before, after, free) => {
    let [least, result] = [before.distanceToSquared(after), before.clone().lerp(after, share)];
    for (const [first, last, now] of frames) {
      const seen = (point: Vector3, { position, turned }: Section) =>
        (free ? point.clone() : point.clone().sub(position)).applyQuaternion(turned.clone().conjugate());
      const [a, b] = [seen(before, first), seen(after, last)];
      const change = a.distanceToSquared(b);
      if (change >= least) continue;
      [least, result] = [change, a.lerp(b, share).applyQuaternion(now.turned)];
      if (!free) result.add(now.position);
    }
    return result;
  };
}

/** The section at a station in the axes of the root: its place, and its rotation vector. */
function displaced(beam: Beam, k: number, { from, to, share }: Instant, factor: number) {
  const m = beam.stations.length;
  const [a, b] = [3 * (m * from + k), 3 * (m * to + k)];
  const component = (of: Float64Array, i: number) => factor * (of[a + i] + share * (of[b + i] - of[a + i]));
  const vector = (of: Float64Array) => new Vector3(component(of, 0), component(of, 1), component(of, 2));
  const place = vector(beam.displacements);
  place.x += beam.stations[k] - beam.stations[0];
  return { place, theta: vector(beam.rotations) };
}

/** Where the tip of a beam is, or a body. */
export function end(part: Part, at: Instant, factor: number): Vector3 {
  const { position, turned } = pose(part, at);
  if (!part.beam) return position;
  const { place } = displaced(part.beam, part.beam.stations.length - 1, at, factor);
  return place.applyQuaternion(turned).add(position);
}

/**
 * The sections of a beam, with displacements and rotations `factor` times as large: `pieces` between neighbouring stations,
 * on cubics through the stations along their tangents.
 */
export function sections(part: Part, at: Instant, factor: number, pieces: number): Section[] {
  const root = pose(part, at);
  const m = part.beam!.stations.length;
  const local = Array.from({ length: m }, (_, k) => {
    const { place, theta } = displaced(part.beam!, k, at, factor);
    return { place, theta, tangent: new Vector3(1, 0, 0).applyQuaternion(rotation(theta)) };
  });
  const inertial = (place: Vector3, theta: Vector3): Section => ({
    position: place.applyQuaternion(root.turned).add(root.position),
    turned: root.turned.clone().multiply(rotation(theta)),
  });
  const result: Section[] = [];
  for (let k = 0; k + 1 < m; k++) {
    const [a, b] = [local[k], local[k + 1]];
    const width = a.place.distanceTo(b.place);
    for (let i = 0; i < pieces; i++) {
      const s = i / pieces;
      const [s2, s3] = [s * s, s * s * s];
      const place = new Vector3()
        .addScaledVector(a.place, 1 - 3 * s2 + 2 * s3)
        .addScaledVector(b.place, 3 * s2 - 2 * s3)
        .addScaledVector(a.tangent, width * (s - 2 * s2 + s3))
        .addScaledVector(b.tangent, width * (s3 - s2));
      result.push(inertial(place, a.theta.clone().lerp(b.theta, s)));
    }
  }
  result.push(inertial(local[m - 1].place, local[m - 1].theta));
  return result;
}
