/** The camera: orbits by mouse and touch, fits the scene, follows a body. */
import { PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Vec3 } from "../model";

const from = new Vector3(0.62, 0.3, 1).normalize();
const margin = 1.06;

export class Camera {
  readonly eye = new PerspectiveCamera(40, 1, 0.1, 1000);
  private readonly controls: OrbitControls;
  private visibleShare = 1;
  private followed: Vector3 | null = null;

  constructor(canvas: HTMLCanvasElement, onChange: () => void) {
    this.controls = new OrbitControls(this.eye, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.zoomToCursor = true;
    this.controls.maxPolarAngle = Math.PI * 0.96;
    this.controls.addEventListener("change", onChange);
  }

  get target(): Vector3 {
    return this.controls.target;
  }
  get distance(): number {
    return this.eye.position.distanceTo(this.controls.target);
  }

  /** Resizes to a window whose bottom `below` pixels are covered by panels; centres the picture above them. */
  resize(width: number, height: number, below: number): void {
    this.eye.aspect = width / Math.max(1, height);
    this.visibleShare = 1 - below / Math.max(1, height);
    this.eye.setViewOffset(width, height, 0, below / 2, width, height);
    this.eye.updateProjectionMatrix();
  }

  /** Views a box (centre, half extents) from slightly above, so that it fills the visible part of the window. */
  frame(centre: Vector3, half: Vector3): void {
    const up = new Vector3(0, 1, 0);
    const right = up.clone().cross(from).normalize();
    const above = from.clone().cross(right);
    const tall = Math.tan((this.eye.fov * Math.PI) / 360) * this.visibleShare;
    const wide = Math.tan((this.eye.fov * Math.PI) / 360) * this.eye.aspect;
    let distance = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const point = half.clone().multiply(new Vector3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
      const towards = point.dot(from);
      distance = Math.max(
        distance,
        towards + Math.max(Math.abs(point.dot(right)) / wide, Math.abs(point.dot(above)) / tall) * margin,
      );
    }
    this.stop();
    this.controls.target.copy(centre);
    this.eye.position.copy(centre).addScaledVector(from, Math.max(distance, 0.5));
    this.controls.minDistance = 0.02 * half.length();
    this.controls.maxDistance = 12 * half.length();
    this.controls.update();
  }

  /** Starts to follow a point; null: stops. */
  follow(point: Vector3 | null): void {
    this.followed = point?.clone() ?? null;
  }
  /** Updates the followed point. */
  moveFollowed(point: Vector3): void {
    if (!this.followed) return;
    const step = point.clone().sub(this.followed);
    this.eye.position.add(step);
    this.controls.target.add(step);
    this.followed.copy(point);
  }

  /** Applies damping after a drag. Returns true while the camera still moves. */
  update(): boolean {
    const { eye } = this;
    const distance = this.distance;
    const near = Math.max(0.01, distance * 0.01);
    const far = Math.max(4000, distance * 40);
    if (eye.near !== near || eye.far !== far) {
      eye.near = near;
      eye.far = far;
      eye.updateProjectionMatrix();
    }
    return this.controls.update();
  }

  /** Eye and target, six numbers. */
  get eyeAndTarget(): number[] {
    return [...this.eye.position.toArray(), ...this.controls.target.toArray()];
  }
  set eyeAndTarget(numbers: number[]) {
    this.stop();
    this.eye.position.fromArray(numbers);
    this.controls.target.fromArray(numbers, 3);
    this.controls.update();
  }

  /** Ends the motion that a drag left behind. */
  private stop(): void {
    this.controls.enableDamping = false; // without damping, an update uses up all of the motion
    this.controls.update();
    this.controls.enableDamping = true;
  }

  /** Returns the ray through a point of the canvas, given as -1 to 1 (right, up). */
  ray(x: number, y: number): { origin: Vec3; direction: Vec3 } {
    this.eye.updateMatrixWorld();
    const origin = this.eye.position;
    const direction = new Vector3(x, y, 0.5).unproject(this.eye).sub(origin).normalize();
    return { origin: origin.toArray() as Vec3, direction: direction.toArray() as Vec3 };
  }
}
