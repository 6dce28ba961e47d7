/** The camera: orbits by mouse and touch, frames the scene, follows a body. */
import { PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Vec3 } from "../model";

const from = new Vector3(0.62, 0.42, 1).normalize();

export class Camera {
    readonly eye = new PerspectiveCamera(40, 1, 0.1, 1000);
    private readonly controls: OrbitControls;
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

    resize(width: number, height: number): void {
        this.eye.aspect = width / Math.max(1, height);
        this.eye.updateProjectionMatrix();
    }

    /** Looks at a ball around `centre` from a little above; `low` is the share of the window that panels cover below. */
    frame(centre: Vector3, radius: number, low: number): void {
        const half = Math.tan((this.eye.fov * Math.PI) / 360);
        const narrow = Math.min((1 - low) * 0.95, this.eye.aspect);
        const distance = (Math.max(radius, 0.2) * 0.95) / (half * narrow);
        this.controls.target.copy(centre);
        this.controls.target.y -= low * half * distance * 0.9;
        this.eye.position.copy(this.controls.target).addScaledVector(from, distance);
        this.controls.minDistance = 0.02 * radius;
        this.controls.maxDistance = 60 * radius;
        this.controls.update();
    }

    /** Goes along with a point from now on; null: stays. */
    follow(at: Vector3 | null): void {
        this.followed = at?.clone() ?? null;
    }
    /** Where the followed point is now. */
    moveFollowed(at: Vector3): void {
        if (!this.followed) return;
        const step = at.clone().sub(this.followed);
        this.eye.position.add(step);
        this.controls.target.add(step);
        this.followed.copy(at);
    }

    /** Swings on after a drag. True while the camera still moves. */
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
    get place(): number[] {
        return [...this.eye.position.toArray(), ...this.controls.target.toArray()];
    }
    set place(numbers: number[]) {
        this.eye.position.fromArray(numbers);
        this.controls.target.fromArray(numbers, 3);
        this.controls.update();
    }

    /** The ray through a point of the canvas, given from -1 to 1 (right, up). */
    ray(x: number, y: number): { origin: Vec3; direction: Vec3 } {
        this.eye.updateMatrixWorld();
        const origin = this.eye.position;
        const direction = new Vector3(x, y, 0.5).unproject(this.eye).sub(origin).normalize();
        return { origin: origin.toArray() as Vec3, direction: direction.toArray() as Vec3 };
    }
}
