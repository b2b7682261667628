// Edges of a surface of triangles.

import { cross, dot, sub, unit, type V3 } from "./space";

/** Triangles that meet at a greater angle than this, rad, have an edge that is seen. */
const SHARP = (25 * Math.PI) / 180;

/** Pairs of nodes: every edge once, and those at which the surface bends sharply or ends. */
export function edges(triangles: Uint32Array, place: (node: number) => V3): [Uint32Array<ArrayBuffer>, Uint32Array<ArrayBuffer>] {
  const normals = new Map<number, V3[]>();
  const pairs = new Map<number, [number, number]>();
  for (let t = 0; t < triangles.length; t += 3) {
    const nodes = [triangles[t]!, triangles[t + 1]!, triangles[t + 2]!] as const;
    const [a, b, c] = nodes.map(place) as [V3, V3, V3];
    const normal = unit(cross(sub(b, a), sub(c, a)));
    for (const [i, j] of [[nodes[0], nodes[1]], [nodes[1], nodes[2]], [nodes[2], nodes[0]]] as const) {
      const key = Math.min(i, j) * 67108864 + Math.max(i, j);
      const known = normals.get(key);
      if (known) known.push(normal);
      else {
        normals.set(key, [normal]);
        pairs.set(key, [i, j]);
      }
    }
  }
  const outline: number[] = [];
  for (const [key, at] of normals) {
    if (at.length !== 2 || dot(at[0]!, at[1]!) < Math.cos(SHARP)) outline.push(...pairs.get(key)!);
  }
  return [Uint32Array.from([...pairs.values()].flat()), Uint32Array.from(outline)];
}
