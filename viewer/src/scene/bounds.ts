/** World boxes of colliders, from shapes and poses. */
import type { Collider, Frame, Shape, Tables, Vec3 } from "../model";
import { combine, rotate } from "./maths";
import type { Poses } from "./poses";

export interface Bounds {
    lo: Vec3;
    hi: Vec3;
}

/** How far a shape reaches from `centre` along the world axes when turned by the columns of `turn`; null: endless. */
function reach(shape: Shape, turn: Vec3[]): { lo: Vec3; hi: Vec3 } | null {
    const both = (half: Vec3) => ({ lo: [-half[0], -half[1], -half[2]] as Vec3, hi: half });
    switch (shape.kind) {
        case "sphere":
            return both([shape.radius, shape.radius, shape.radius]);
        case "box":
            return both([0, 1, 2].map((i) => turn.reduce((sum, column, k) => sum + Math.abs(column[i]) * shape.half[k], 0)) as Vec3);
        case "capsule":
            return both(turn[1].map((y) => Math.abs(y) * shape.halfLength + shape.radius) as Vec3);
        case "cylinder":
            return both(
                turn[1].map((y) => Math.abs(y) * shape.halfHeight + Math.sqrt(Math.max(0, 1 - y * y)) * shape.radius) as Vec3,
            );
        case "convex hull":
        case "mesh": {
            const lo: Vec3 = [Infinity, Infinity, Infinity];
            const hi: Vec3 = [-Infinity, -Infinity, -Infinity];
            const { vertices } = shape.mesh;
            for (let v = 0; v < vertices.length; v += 3)
                for (let i = 0; i < 3; ++i) {
                    const x = turn[0][i] * vertices[v] + turn[1][i] * vertices[v + 1] + turn[2][i] * vertices[v + 2];
                    if (x < lo[i]) lo[i] = x;
                    if (x > hi[i]) hi[i] = x;
                }
            return { lo, hi };
        }
        case "half-space":
            return null;
    }
}

/** The world box of a collider as posed; null for a half-space. */
export function worldBox(tables: Tables, collider: Collider, poses: Poses): Bounds | null {
    const b = 3 * collider.body;
    const r = 4 * collider.body;
    const { position, rotation } = combine(
        {
            position: [poses.positions[b], poses.positions[b + 1], poses.positions[b + 2]],
            rotation: [poses.rotations[r], poses.rotations[r + 1], poses.rotations[r + 2], poses.rotations[r + 3]],
        },
        collider.pose,
    );
    const axes: Vec3[] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const around = reach(tables.shapes[collider.shape], axes.map((axis) => rotate(rotation, axis)));
    if (!around) return null;
    const at = (v: Vec3) => [position[0] + v[0], position[1] + v[1], position[2] + v[2]] as Vec3;
    return { lo: at(around.lo), hi: at(around.hi) };
}

/** Is the collider there at the frame? */
export const isThere = (collider: Collider, frame: Frame): boolean =>
    frame.present[collider.body] === 1 && frame.number >= collider.from && frame.number < collider.to;

/** A box around what is worth looking at: all that moves and, unless much larger, all that does not. */
export function boundsOfInterest(tables: Tables, poses: Poses): Bounds {
    const grow = (into: Bounds | null, box: Bounds): Bounds =>
        into
            ? {
                  lo: into.lo.map((x, i) => Math.min(x, box.lo[i])) as Vec3,
                  hi: into.hi.map((x, i) => Math.max(x, box.hi[i])) as Vec3,
              }
            : box;
    let moving: Bounds | null = null;
    let all: Bounds | null = null;
    for (const collider of tables.colliders) {
        if (!poses.frame || !isThere(collider, poses.frame) || collider.sensor) continue;
        const box = worldBox(tables, collider, poses);
        if (!box) continue;
        all = grow(all, box);
        if (tables.bodies[collider.body].kind !== 0) moving = grow(moving, box);
    }
    const size = (box: Bounds) => Math.hypot(...box.hi.map((x, i) => x - box.lo[i]));
    if (!all) return { lo: [-2, 0, -2], hi: [2, 2, 2] };
    return moving && size(all) > 2 * size(moving) ? moving : all;
}
