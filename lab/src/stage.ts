// The picture in space: parts, obstacles, the path of the tip, a scale.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { recoloured, styled } from "./colours";
import type { Room } from "./room";
import { KINDS, type Part, type Scene, type Section } from "./scene";
import { nice, text } from "./text";

/** What stands where at one time. */
export interface Picture {
  /** Pose of every part. */
  poses: Section[];
  /** Sections of every part that is a beam. */
  sections: (Section[] | undefined)[];
  /** Points of every obstacle. */
  outlines: THREE.Vector3[][];
  /** Axes of the beams of the answer it is compared with. */
  others?: THREE.Vector3[][];
  /** Forces and couples by their kinds: where, and an arrow or an axis. */
  acting?: [THREE.Vector3, THREE.Vector3][][];
  /** Forces per length: where along each, and an arrow. */
  along?: [THREE.Vector3, THREE.Vector3][][];
  /** The frame of reference: what is drawn is seen from it. */
  frame: Section;
}

/** Where a picture is looked from. */
export interface Seen {
  size: number;
  extent: number;
  position: THREE.Vector3;
  up: THREE.Vector3;
  target: THREE.Vector3;
  zoom: number;
}

export type View = "xy" | "xz" | "yz" | "space";

const directions: Record<View, [THREE.Vector3, THREE.Vector3]> = {
  xy: [new THREE.Vector3(0, 0, 1), new THREE.Vector3(0, 1, 0)],
  xz: [new THREE.Vector3(0, -1, 0), new THREE.Vector3(0, 0, 1)],
  yz: [new THREE.Vector3(1, 0, 0), new THREE.Vector3(0, 0, 1)],
  space: [new THREE.Vector3(0.5, -0.75, 0.45), new THREE.Vector3(0, 0, 1)],
};

/** Colours by the names of the style sheet. */
const colour = (name: string) => new THREE.Color(styled(name));

/** One renderer a canvas: browsers allow few of them. */
const renderers = new WeakMap<HTMLCanvasElement, THREE.WebGLRenderer>();

/** Canvases that have shown a picture. */
const used = new WeakSet<HTMLCanvasElement>();

/** None where the browser has no WebGL. */
function renderer(canvas: HTMLCanvasElement): THREE.WebGLRenderer | undefined {
  if (renderers.has(canvas)) return renderers.get(canvas);
  const context = canvas.getContext("webgl2", { antialias: true, alpha: true, preserveDrawingBuffer: true });
  if (!context) return undefined;
  const made = new THREE.WebGLRenderer({ canvas, context });
  renderers.set(canvas, made);
  return made;
}

class Line {
  readonly object: Line2;
  private readonly material: LineMaterial;

  constructor(
    readonly name: string,
    width: number,
    dash = 0,
  ) {
    this.material = new LineMaterial({ linewidth: width, dashed: dash > 0, dashSize: dash, gapSize: dash });
    this.object = new Line2(new LineGeometry(), this.material);
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  place(points: THREE.Vector3[]) {
    if (points.length < 2) return;
    // A new geometry only where the number of points changes.
    const start = this.object.geometry.getAttribute("instanceStart") as THREE.InterleavedBufferAttribute | undefined;
    if (start?.count === points.length - 1) {
      const buffer = start.data.array as Float32Array;
      for (let i = 0; i + 1 < points.length; i++) {
        points[i].toArray(buffer, 6 * i);
        points[i + 1].toArray(buffer, 6 * i + 3);
      }
      start.data.needsUpdate = true;
    } else {
      this.object.geometry.dispose();
      this.object.geometry = new LineGeometry();
      this.object.geometry.setPositions(points.flatMap((p) => [p.x, p.y, p.z]));
    }
    if (this.material.dashed) this.object.computeLineDistances();
    this.object.visible = true;
  }

  paint() {
    this.material.color = colour(this.name);
  }
}

/** A beam as a prism of its section, with its axis. */
class Body {
  readonly group = new THREE.Group();
  private readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshLambertMaterial>;
  private readonly axis = new Line("beam", 2.5);
  private readonly rigid: Line;

  constructor(private readonly part: Part) {
    this.mesh = new THREE.Mesh(
      new THREE.BufferGeometry(),
      new THREE.MeshLambertMaterial({ flatShading: true, side: THREE.DoubleSide, transparent: true, opacity: 0.75 }),
    );
    this.mesh.frustumCulled = false;
    const { stations } = part.beam!;
    this.rigid = new Line("faint", 1.25, (stations[stations.length - 1] - stations[0]) / 60);
    this.group.add(this.rigid.object, this.mesh, this.axis.object);
  }

  place(root: Section, sections: Section[]) {
    const [height, width] = this.part.beam!.section;
    const corners = [
      [-1, -1],
      [1, -1],
      [1, 1],
      [-1, 1],
    ].map(([a, b]) => new THREE.Vector3(0, (a * height) / 2, (b * width) / 2));
    const points = sections.flatMap((section) =>
      corners.flatMap((corner) => corner.clone().applyQuaternion(section.turned).add(section.position).toArray()),
    );
    const { geometry } = this.mesh;
    const position = geometry.getAttribute("position") as THREE.BufferAttribute | undefined;
    if (position?.array.length === points.length) {
      (position.array as Float32Array).set(points);
      position.needsUpdate = true;
    } else {
      const last = 4 * (sections.length - 1);
      const index = [0, 1, 2, 0, 2, 3, last, last + 2, last + 1, last, last + 3, last + 2];
      for (let k = 0; k < last; k += 4) {
        for (let i = 0; i < 4; i++) {
          const [a, b] = [k + i, k + ((i + 1) % 4)];
          index.push(a, a + 4, b, b, a + 4, b + 4);
        }
      }
      geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
      geometry.setIndex(index);
    }
    this.axis.place(sections.map((section) => section.position));
    const { stations, straight } = this.part.beam!;
    if (!straight) return;
    const along = new THREE.Vector3(stations[stations.length - 1] - stations[0], 0, 0);
    this.rigid.place([root.position, along.applyQuaternion(root.turned).add(root.position)]);
  }

  paint() {
    this.mesh.material.color = colour("body");
    this.axis.paint();
    this.rigid.paint();
  }
}

/** A hub as a disc, or a rigid body as a box. */
class Solid {
  readonly group = new THREE.Group();
  private readonly edge = new Line("hub", 1.5);
  private readonly edges = new THREE.LineBasicMaterial();
  private readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshLambertMaterial>;

  constructor(part: Part, size: number) {
    const material = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, transparent: true, opacity: 0.35 });
    if (part.box) {
      const [x, y, z, a, b, c] = part.box;
      this.mesh = new THREE.Mesh(new THREE.BoxGeometry(a, b, c), material);
      this.mesh.position.set(x, y, z);
      this.mesh.add(new THREE.LineSegments(new THREE.EdgesGeometry(this.mesh.geometry), this.edges));
    } else {
      const radius = part.beam?.hub || 0.012 * size;
      const around = Array.from({ length: 73 }, (_, k) => (k * Math.PI) / 36);
      const circle = around.map((a) => new THREE.Vector3(radius * Math.cos(a), radius * Math.sin(a), 0));
      this.mesh = new THREE.Mesh(new THREE.CircleGeometry(radius, 72), material);
      this.edge.place(circle);
      // The centre of the hub lies behind the root.
      for (const object of [this.mesh, this.edge.object]) object.position.x = -(part.beam?.hub ?? 0);
    }
    this.group.add(this.mesh, this.edge.object);
  }

  place(root: Section) {
    this.group.position.copy(root.position);
    this.group.quaternion.copy(root.turned);
  }

  paint() {
    this.mesh.material.color = colour("hub");
    this.edges.color = colour("hub");
    this.edge.paint();
  }
}

/** Makes renderer and shaders of a canvas before there is something to be drawn. */
export function warm(canvas: HTMLCanvasElement) {
  const made = renderer(canvas);
  if (!made) return;
  const space = new THREE.Scene();
  const lines = [new Line("beam", 1), new Line("faint", 1, 1)];
  // Behind the camera.
  for (const line of lines) line.place([new THREE.Vector3(0, 0, 9), new THREE.Vector3(1, 0, 9)]);
  const meshes = [true, false].map((flatShading) => {
    const material = new THREE.MeshLambertMaterial({ flatShading, side: THREE.DoubleSide, transparent: true, opacity: 0.5 });
    const mesh = new THREE.Mesh(new THREE.CircleGeometry(1, 3), material);
    mesh.position.z = 9;
    mesh.frustumCulled = false;
    return mesh;
  });
  space.add(...lines.map((line) => line.object), ...meshes, new THREE.AmbientLight(), new THREE.DirectionalLight());
  made.render(space, new THREE.OrthographicCamera());
}

/** Three quarters of a circle about an axis, with a point at its end: as wide as the axis is long. */
function arc(at: THREE.Vector3, along: THREE.Vector3): THREE.Vector3[] {
  const radius = 0.4 * along.length();
  const axis = along.clone().normalize();
  const first = (Math.abs(axis.z) > 0.9 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 0, 1)).cross(axis).normalize();
  const point = (angle: number, r = radius) =>
    first.clone().applyAxisAngle(axis, angle).multiplyScalar(r).add(at);
  const end = 1.5 * Math.PI;
  const points = Array.from({ length: 37 }, (_, k) => point((k * end) / 36));
  return [...points, point(end - 0.45, 1.25 * radius), point(end), point(end - 0.45, 0.75 * radius)];
}

export class Stage {
  readonly size: number;
  /** Size of all that is shown, in the plane of the picture. */
  private extent = 0;
  private readonly renderer: THREE.WebGLRenderer | undefined;
  private readonly camera = new THREE.OrthographicCamera();
  private readonly controls: OrbitControls;
  private readonly space = new THREE.Scene();
  private readonly world = new THREE.Group();
  private readonly bodies: (Body | undefined)[];
  private readonly solids: (Solid | undefined)[];
  private readonly outlines: Line[];
  private readonly paths: Line[] = [];
  private readonly others: Line[] = [];
  private readonly acting: Line[][] = KINDS.map(() => []);
  private readonly along: Line[] = [];
  private readonly axes: Line[];

  /** Width of the picture [px], and what the scale shows: asking the page for them would lay it out anew. */
  private width = 0;
  private scale: string[] = [];
  /** The camera is moved, and a picture follows. */
  private moving = false;
  /** What stands beside the first picture of a canvas is painted first: its shaders take as long as all the rest. */
  private waiting: boolean;
  private readonly canvas: HTMLCanvasElement;
  private readonly bar: HTMLElement;

  constructor({ canvas, scale, signal }: Room, scene: Scene) {
    [this.canvas, this.bar] = [canvas, scale];
    this.renderer = renderer(canvas);
    this.waiting = !used.has(canvas);
    const length = ({ beam, box }: Part) =>
      beam ? (beam.hub ?? 0) + beam.stations[beam.stations.length - 1] : Math.max(...box!.slice(3));
    this.size = Math.max(...scene.parts.map(length));
    this.bodies = scene.parts.map((part) => part.beam && new Body(part));
    this.solids = scene.parts.map((part) =>
      part.box || part.beam?.hub !== undefined ? new Solid(part, this.size) : undefined,
    );
    this.outlines = scene.outlines.map(() => new Line("obstacle", 2.5));
    this.axes = scene.planar ? [] : ["x", "y", "z"].map((name) => new Line(name, 1.5));
    const names = this.axes.map(({ name }) => {
      const letter = Object.assign(document.createElement("b"), { textContent: name });
      letter.style.color = `var(--${name})`;
      return letter;
    });
    scale.after(...names);
    this.axes.forEach((axis, i) => {
      const end = new THREE.Vector3().setComponent(i, 0.15 * this.size);
      axis.place([new THREE.Vector3(), end]);
    });
    const groups = [...this.bodies, ...this.solids].flatMap((drawn) => (drawn ? [drawn.group] : []));
    const lines = [...this.outlines, ...this.axes];
    this.world.add(...groups, ...lines.map((line) => line.object));
    this.space.add(this.world, new THREE.AmbientLight(0xffffff, 1.6), this.camera);
    const light = new THREE.DirectionalLight(0xffffff, 2);
    light.position.set(-0.4, 0.6, 1);
    this.camera.add(light);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.enableRotate = !scene.planar;
    if (scene.planar) {
      this.controls.mouseButtons.LEFT = THREE.MOUSE.PAN;
      this.controls.touches.ONE = THREE.TOUCH.PAN;
    }
    this.controls.addEventListener("change", () => this.moving || this.looked());
    const observer = new ResizeObserver(() => this.waiting || this.resize());
    observer.observe(canvas.parentElement!);
    recoloured(() => {
      this.paint();
      this.begin();
      this.render();
      // Chromium prints the picture as it was when it was last read.
      canvas.toDataURL();
    }, signal);
    signal.addEventListener("abort", () => {
      observer.disconnect();
      this.controls.dispose();
      const materials: THREE.Material[] = [];
      this.space.traverse((object) => {
        const { geometry, material } = object as THREE.Mesh;
        geometry?.dispose();
        materials.push(...[material ?? []].flat());
      });
      // A shader that no material uses is compiled anew: the next answer uses it first.
      setTimeout(() => materials.forEach((material) => material.dispose()), 2000);
    });
    this.paint();
    this.turn(scene.planar ? "xy" : "space");
    if (this.waiting) requestAnimationFrame(() => requestAnimationFrame(() => signal.aborted || this.begin()));
  }

  /** The first picture waits no longer. */
  private begin() {
    used.add(this.canvas);
    if (!this.waiting) return;
    this.waiting = false;
    this.resize();
  }

  /** Draws from where the user looks, if nobody else does. */
  private looked() {
    if (this.canvas.dispatchEvent(new Event("turned", { cancelable: true }))) this.render();
  }

  /** Looks from a side. */
  turn(view: View) {
    const [direction, up] = directions[view];
    this.camera.up.copy(up);
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(direction).setLength(20 * this.size);
    this.camera.near = 0.1 * this.size;
    this.camera.far = 40 * this.size;
    this.move();
  }

  /** Shows all the points. */
  fit(points: THREE.Vector3[]) {
    this.camera.updateMatrixWorld();
    const seen = points.map((point) => point.clone().applyMatrix4(this.camera.matrixWorldInverse));
    const box = new THREE.Box3().setFromPoints(seen);
    const [centre, size] = [box.getCenter(new THREE.Vector3()), box.getSize(new THREE.Vector3())];
    this.extent = Math.max(size.x, size.y);
    const shift = new THREE.Vector3(centre.x, centre.y, 0).applyQuaternion(this.camera.quaternion);
    this.controls.target.add(shift);
    this.camera.position.add(shift);
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement!;
    const [right, top] = [this.camera.right, this.camera.top];
    // Room for the tools above and the scale below.
    const margin = Math.min(0.2 * height, 52);
    const floor = 0.05 * this.size;
    this.camera.zoom = Math.min(
      (2 * right * 0.9) / Math.max(size.x, floor),
      (2 * top * ((height - 2 * margin) / height)) / Math.max(size.y, floor),
    );
    if (width === 0) this.camera.zoom = 1;
    this.camera.updateProjectionMatrix();
    this.move();
    this.render();
  }

  /** Places everything. */
  place(picture: Picture) {
    const { position, turned } = picture.frame;
    this.world.quaternion.copy(turned).conjugate();
    this.world.position.copy(position).negate().applyQuaternion(this.world.quaternion);
    picture.poses.forEach((pose, i) => {
      const sections = picture.sections[i];
      if (sections) this.bodies[i]?.place(pose, sections);
      this.solids[i]?.place(pose);
    });
    picture.outlines.forEach((points, i) => this.outlines[i].place(points));
    this.draw(this.others, picture.others ?? [], () => new Line("curve1", 2.5, this.size / 40));
    this.acting.forEach((lines, kind) => {
      const drawn = (picture.acting?.[kind] ?? []).map(([at, along]) => (kind % 2 === 0 ? this.pointed(at, along) : arc(at, along)));
      this.draw(lines, drawn, () => (kind < 2 ? new Line("force", 2) : new Line("dim", 1.5)));
    });
    this.draw(this.along, (picture.along ?? []).map((arrows) => this.row(arrows)), () => new Line("force", 1.25));
  }

  /** Whether there is a picture at all. */
  get shown(): boolean {
    return this.renderer !== undefined;
  }

  /** Length of the longest arrow: by the model, or by what is shown where that is far larger, or smaller, as of a beam that is rolled up. */
  get arrow(): number {
    const { size, extent } = this;
    return 0.2 * (extent > 0 ? Math.max(Math.min(size, extent), 0.5 * extent) : size);
  }

  /** Where it is looked from. */
  get seen(): Seen {
    const { position, up, zoom } = this.camera;
    return { size: this.size, extent: this.extent, position: position.clone(), up: up.clone(), target: this.controls.target.clone(), zoom };
  }

  /** Looks from where another was seen, if that was of the same size. */
  look({ size, extent, position, up, target, zoom }: Seen): boolean {
    if (Math.abs(size / this.size - 1) > 0.3) return false;
    this.extent = extent;
    this.camera.position.copy(position);
    this.camera.up.copy(up);
    this.camera.zoom = zoom;
    this.controls.target.copy(target);
    this.camera.updateProjectionMatrix();
    this.move();
    return true;
  }

  private move() {
    this.moving = true;
    this.controls.update();
    this.moving = false;
  }

  /** As many lines as there are lists of points. */
  private draw(lines: Line[], all: THREE.Vector3[][], make: () => Line, into: THREE.Object3D = this.world) {
    while (lines.length < all.length) {
      const line = make();
      line.paint();
      into.add(line.object);
      lines.push(line);
    }
    lines.forEach((line, i) => {
      if (all[i]) line.place(all[i]);
      line.object.visible = all[i] !== undefined && all[i].length > 1;
    });
  }

  private pointed(at: THREE.Vector3, along: THREE.Vector3): THREE.Vector3[] {
    const end = at.clone().add(along);
    const sight = this.camera.position.clone().sub(this.controls.target);
    const side = along.clone().cross(sight.applyQuaternion(this.world.quaternion.clone().conjugate()));
    side.setLength(0.12 * along.length());
    const neck = at.clone().addScaledVector(along, 0.75);
    return [at, end, neck.clone().add(side), end, neck.clone().sub(side)];
  }

  /** Arrows whose ends a line joins. */
  private row(arrows: [THREE.Vector3, THREE.Vector3][]): THREE.Vector3[] {
    return arrows.flatMap(([at, along]) => {
      const [, end, left, , right] = this.pointed(at, along);
      return [end, at, end, left, end, right, end];
    });
  }

  /** Paths of points, as seen from the frame of reference. */
  trace(paths: THREE.Vector3[][]) {
    this.draw(this.paths, paths, () => new Line("path", 1.5), this.space);
  }

  /** Draws the first `count` points of the paths. */
  follow(count: number) {
    for (const { object } of this.paths) object.geometry.instanceCount = Math.max(count - 1, 0);
  }

  render() {
    if (!this.renderer || this.width === 0) return;
    this.renderer.render(this.space, this.camera);
    const pixel = (this.camera.right - this.camera.left) / this.camera.zoom / this.width;
    const length = nice(110 * pixel);
    const scale = [`${length / pixel}px`, `${text(length)} m`];
    if (scale.join() === this.scale.join()) return;
    this.scale = scale;
    [this.bar.style.width, this.bar.textContent] = scale;
  }

  private resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement!;
    this.width = width;
    if (width === 0 || height === 0) return;
    this.renderer?.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer?.setSize(width, height, false);
    const half = this.size;
    const ratio = width / height;
    [this.camera.left, this.camera.right] = [-half * ratio, half * ratio];
    [this.camera.bottom, this.camera.top] = [-half, half];
    this.camera.updateProjectionMatrix();
    this.canvas.dispatchEvent(new Event("resized"));
  }

  private paint() {
    const lines = [...this.outlines, ...this.paths, ...this.axes, ...this.others, ...this.acting.flat(), ...this.along];
    for (const drawn of [...this.bodies, ...this.solids, ...lines]) drawn?.paint();
  }
}
