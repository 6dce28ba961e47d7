/** The view of a recording: stage, bodies, overlays and camera. */
import { Matrix4, Quaternion, Vector3 } from "three";
import type { Frame, Selection, Tables, Vec3 } from "../model";
import { traitsOf } from "../shapes/list";
import type { Bounds } from "./bounds";
import { Camera } from "./camera";
import type { Colouring } from "./colours";
import { ContactLayer } from "./contacts";
import { coarsest, DetailedBodies } from "./detail";
import { makeGround } from "./ground";
import { Highlight } from "./highlight";
import { boundsOfInterest } from "./interest";
import { combine } from "./maths";
import { pick } from "./pick";
import { Poses } from "./poses";
import { type Saving, savesNothing, savingOf } from "./quality";
import { Stage } from "./stage";
import { WorldBoxes } from "./world_boxes";

/** more triangles than this are simplified even in still pictures */
const maxStillTriangles = { software: 1e6, hardware: 2e7 };
/** without a graphics card, pictures of a motion begin with at most this many; shadows count again */
const maxMovingTriangles = 1e5;

export class View {
  readonly poses: Poses;
  readonly camera: Camera;
  colouring: Colouring = "material";
  private readonly stage: Stage;
  private readonly origin: Vec3;
  private readonly bodies: DetailedBodies;
  private readonly boxes: WorldBoxes;
  private readonly contacts: ContactLayer;
  private readonly highlight: Highlight;
  private readonly centre: Vector3;
  private readonly half: Vector3;
  private readonly radius: number;
  private width = 1;
  private height = 1;
  /** the degree of detail of still pictures */
  private readonly finest: number;
  private saved = savesNothing;
  private selection: Selection | null = null;
  private followed: number | null = null;

  /** Throws when the browser has no WebGL 2. `onChange`: the camera moved. */
  constructor(
    canvas: HTMLCanvasElement,
    private readonly tables: Tables,
    first: Frame,
    isSoftware: boolean,
    onChange: () => void,
  ) {
    this.stage = new Stage(canvas, isSoftware);
    this.poses = new Poses(tables.bodies.length);
    this.poses.mix(first, first, 0);
    const bounds = boundsOfInterest(tables, this.poses);
    this.origin = bounds.lo.map((x, i) => Math.round((x + bounds.hi[i]) / 2)) as Vec3;
    const relative = (v: Vec3) => new Vector3(...v).sub(new Vector3(...this.origin));
    this.centre = relative(bounds.lo).add(relative(bounds.hi)).multiplyScalar(0.5);
    this.half = relative(bounds.hi).sub(relative(bounds.lo)).multiplyScalar(0.5);
    this.radius = Math.max(0.5, this.half.length());
    this.bodies = new DetailedBodies(tables, this.origin);
    this.finest = this.firstDetailWithin(isSoftware ? maxStillTriangles.software : maxStillTriangles.hardware);
    this.boxes = new WorldBoxes(tables, this.origin);
    this.contacts = new ContactLayer(this.origin, this.radius * 0.02);
    this.highlight = new Highlight(tables, this.bodies.parts, this.origin);
    for (const object of [this.bodies.group, this.boxes.object, this.contacts.group, this.highlight.group])
      this.stage.add(object);
    this.addGround(bounds);
    this.camera = new Camera(canvas, onChange);
  }

  /** `below`: pixels at the bottom that panels cover. */
  resize(width: number, height: number, below: number): void {
    this.width = width;
    this.height = height;
    this.stage.resize(width, height);
    this.camera.resize(width, height, below);
  }

  /** Shows the full scene. */
  reframe(): void {
    this.camera.frame(this.centre, this.half);
  }

  /** Shows the interpolation of two frames. */
  show(a: Frame, b: Frame, share: number): void {
    this.poses.mix(a, b, share);
    if (this.bodies.show(this.poses, this.colouring)) this.stage.invalidateShadows();
    this.boxes.update(this.poses);
    this.contacts.update(a);
    this.highlight.update(this.poses, this.camera.eye);
    if (this.followed !== null && this.poses.present[this.followed])
      this.camera.moveFollowed(this.positionOf(this.followed));
  }

  /** Draws one picture. Returns true while the camera still moves. */
  draw(saving: Saving = savesNothing): boolean {
    const isMoving = this.camera.update();
    this.highlight.update(this.poses, this.camera.eye);
    const { target, distance } = this.camera;
    const near = target.distanceTo(this.centre) < 2 * this.radius && distance > this.radius;
    const focus = near ? this.centre : target;
    if (this.bodies.show(this.poses, this.colouring, this.finest + saving.coarser)) this.stage.invalidateShadows();
    this.stage.render(this.camera.eye, saving, focus, near ? this.radius * 1.35 : Math.max(distance, 1), distance);
    this.saved = saving;
    return isMoving;
  }

  /** Whether the last picture left something out. */
  get isCoarse(): boolean {
    return this.saved.share < 1 || !this.saved.shadows || this.saved.coarser > 0;
  }

  /** How many steps coarser than in still pictures the shapes can be drawn. */
  get coarserSteps(): number {
    return coarsest - this.finest;
  }
  /** Returns the first level of savings (quality.ts) whose pictures draw few enough triangles to move without a graphics card. */
  get softwareLevel(): number {
    const costs = Array.from({ length: 2 + this.coarserSteps }, (_, level) => {
      const { shadows, coarser } = savingOf(level, 1);
      return (shadows ? 2 : 1) * this.bodies.trianglesAt(this.finest + coarser);
    });
    const level = costs.findIndex((cost) => cost <= maxMovingTriangles);
    return level < 0 ? costs.length - 1 : level;
  }

  set showsBoxes(on: boolean) {
    this.boxes.object.visible = on;
    this.boxes.update(this.poses);
  }
  set showsContacts(on: boolean) {
    this.contacts.group.visible = on;
    if (this.poses.frame) this.contacts.update(this.poses.frame);
  }

  /** Returns the shape at a point of the window, in CSS pixels; null: none, or the ground. */
  pickAt(x: number, y: number): Selection | null {
    const ray = this.camera.ray((2 * x) / this.width - 1, 1 - (2 * y) / this.height);
    const origin = ray.origin.map((c, i) => c + this.origin[i]) as Vec3;
    const picked = pick(this.tables, this.poses, { origin, direction: ray.direction });
    if (!picked) return null;
    const { body, collider } = picked;
    if (traitsOf(this.tables.shapes[this.tables.colliders[collider].shape]).isGround) return null;
    return { body, shape: this.tables.bodies[body].colliders.indexOf(collider) };
  }
  select(selection: Selection | null): void {
    this.selection = selection;
    this.highlight.show(selection);
    this.highlight.update(this.poses, this.camera.eye);
  }
  get selected(): Selection | null {
    return this.selection;
  }
  /** Makes the camera follow a body; null: stops. */
  follow(row: number | null): void {
    this.followed = row;
    this.camera.follow(row === null ? null : this.positionOf(row));
  }

  /** Returns the window position of a world point, in CSS pixels. */
  project(point: Vec3): { x: number; y: number } {
    const projected = new Vector3(...point).sub(new Vector3(...this.origin));
    this.camera.eye.updateMatrixWorld();
    projected.project(this.camera.eye);
    return { x: ((projected.x + 1) / 2) * this.width, y: ((1 - projected.y) / 2) * this.height };
  }

  /** Returns the finest degree of detail with at most `count` triangles, or the second coarsest. */
  private firstDetailWithin(count: number): number {
    let detail = 0;
    while (detail < coarsest - 1 && this.bodies.trianglesAt(detail) > count) ++detail;
    return detail;
  }

  private positionOf(row: number): Vector3 {
    return new Vector3().fromArray(this.poses.positions, 3 * row).sub(new Vector3(...this.origin));
  }

  /** Adds solid ground for each shape that is ground; a grid of lines below scenes without one. */
  private addGround(bounds: Bounds): void {
    const cell = 10 ** Math.max(-1, Math.round(Math.log10(this.radius / 8)));
    const { tables, poses } = this;
    let found = false;
    for (const { body, shape, pose } of tables.colliders) {
      if (!traitsOf(tables.shapes[shape]).isGround || !poses.present[body]) continue;
      const world = combine(
        {
          position: Array.from(poses.positions.subarray(3 * body, 3 * body + 3)) as Vec3,
          rotation: Array.from(poses.rotations.subarray(4 * body, 4 * body + 4)) as [number, number, number, number],
        },
        pose,
      );
      found = true;
      const rotation = new Quaternion(...world.rotation);
      const up = new Vector3(0, 1, 0).applyQuaternion(rotation);
      const position = new Vector3(...world.position).sub(new Vector3(...this.origin));
      // the plane is unbounded: draw it around the point nearest to the scene, where its grid is precise
      const near = this.centre.clone().addScaledVector(up, -this.centre.clone().sub(position).dot(up));
      const snapped = position.add(
        near
          .sub(position)
          .multiplyScalar(1 / (10 * cell))
          .round()
          .multiplyScalar(10 * cell)
          .projectOnPlane(up),
      );
      this.stage.add(
        makeGround(new Matrix4().compose(snapped, rotation, new Vector3(1, 1, 1)), true, cell, 2.5 * this.radius),
      );
    }
    if (found) return;
    const low = new Vector3(0, bounds.lo[1] - this.origin[1] - 0.002 * this.radius, 0);
    this.stage.add(makeGround(new Matrix4().makeTranslation(low), false, cell, 2.5 * this.radius));
  }
}
