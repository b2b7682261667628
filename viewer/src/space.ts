// Vectors, matrices (columns first, as WebGL has them), and what a computed part is of the whole body.

import type { Part } from "./data";

export type V3 = [number, number, number];

export const add = (a: V3, b: V3): V3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a: V3, b: V3): V3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a: V3, s: number): V3 => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: V3, b: V3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: V3, b: V3): V3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const length = (a: V3): number => Math.hypot(...a);
export const unit = (a: V3): V3 => times(a, 1 / (length(a) || 1));

/** Rows of a rotation or reflection. */
export type M3 = [V3, V3, V3];
export const IDENTITY: M3 = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
export const apply = (m: M3, v: V3): V3 => [dot(m[0], v), dot(m[1], v), dot(m[2], v)];

export type M4 = Float32Array;

export function multiply(a: M4, b: M4): M4 {
  const c = new Float32Array(16);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * k + row]! * b[4 * column + k]!;
      c[4 * column + row] = sum;
    }
  }
  return c;
}

export function matrix(m: M3): M4 {
  const c = new Float32Array(16);
  for (let row = 0; row < 3; row++) for (let column = 0; column < 3; column++) c[4 * column + row] = m[row]![column]!;
  c[15] = 1;
  return c;
}

export function perspective(focal: number, aspect: number, near: number, far: number): M4 {
  const m = new Float32Array(16);
  m[0] = focal / aspect;
  m[5] = focal;
  m[10] = -(far + near) / (far - near);
  m[11] = -1;
  m[14] = (-2 * far * near) / (far - near);
  return m;
}

export function lookAt(eye: V3, right: V3, up: V3, back: V3): M4 {
  const rows = [right, up, back];
  const m = matrix(rows as M3);
  rows.forEach((row, i) => (m[12 + i] = -dot(row, eye)));
  return m;
}

/** How much of the body is shown. */
export type Extent = "part" | "open" | "whole";

function reflection(normal: V3): M3 {
  return IDENTITY.map((row, i) => row.map((x, j) => x - 2 * normal[i]! * normal[j]!)) as M3;
}

/** In the plane across the axis, at an angle from the first direction after the axis. */
export function direction(axis: number, angle: number): V3 {
  const v: V3 = [0, 0, 0];
  v[(axis + 1) % 3] = Math.cos(angle);
  v[(axis + 2) % 3] = Math.sin(angle);
  return v;
}

function rotation(axis: number, angle: number): M3 {
  const m: M3 = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  const [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  m[axis]![axis] = 1;
  m[a]![a] = c;
  m[a]![b] = -s;
  m[b]![a] = s;
  m[b]![b] = c;
  return m;
}

function product(a: M3, b: M3): M3 {
  const column = (j: number): V3 => [b[0][j]!, b[1][j]!, b[2][j]!];
  return a.map((row) => [0, 1, 2].map((j) => dot(row, column(j)))) as M3;
}

/** The images of the computed part that make up the body, itself first. */
export function copies(part: Part | null, extent: Extent): M3[] {
  if (!part || extent === "part") return [IDENTITY];
  if (part.kind === "half") {
    const normal: V3 = [0, 0, 0];
    normal[part.axis] = 1;
    return [IDENTITY, reflection(normal)];
  }
  const count = Math.round((2 * Math.PI) / part.angle);
  const shown = extent === "open" ? Math.max(1, Math.floor(0.75 * count)) : count;
  return Array.from({ length: shown }, (_, k) => {
    const turned = rotation(part.axis, k * part.angle);
    // Mirrored and plain ones by turns, so that faces fit, if the last fits the first.
    const mirrored = k % 2 === 1 && count % 2 === 0;
    if (!mirrored) return turned;
    const across = direction(part.axis, part.angle / 2 + Math.PI / 2);
    return product(turned, reflection(across));
  });
}
