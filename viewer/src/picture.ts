// What is drawn, whoever draws it.

import type { M3, M4, V3 } from "./space";

/** Pixels that a particle is at least wide, and at most. */
export const LEAST = 1.5;
export const MOST = 64;

/** What a number is made of: the array of its field, and how. */
export interface Shown {
  /** As half floats, `components` beside each other; or whole numbers if `kinds`. */
  codes: Uint16Array<ArrayBuffer>;
  components: 1 | 3 | 6;
  kinds: boolean;
  /** The length of the vector in place of a component. */
  whole: boolean;
  component: number;
  /** In units of the codes. */
  range: [number, number];
  palette: Uint8Array<ArrayBuffer>;
}

export interface Picture {
  view: M4;
  copies: M3[];
  /** Times that displacements are drawn. */
  magnified: number;
  /** Times that particles are drawn as large as they are apart. */
  blown: number;
  clip: [number, number, number, number];
  background: V3;
  ink: V3;
  edges: number;
  outline: boolean;
}

/** Draws particles and the mesh's edges. */
export interface Renderer {
  /** Where displacements count from, as parts of a box. */
  setOrigins(codes: Uint16Array<ArrayBuffer>, low: number[], extent: number[]): void;
  /** Displacements as half floats of `one`. */
  setMoved(codes: Uint16Array<ArrayBuffer>, one: number): void;
  /** Diameters, m; 0 for what is not there. */
  setSizes(sizes: Float32Array<ArrayBuffer>): void;
  setShown(shown: Shown): void;
  /** The same field with other colours. */
  setColours(shown: Shown): void;
  /** Nodes of the surface as parts of a box, and pairs of them: all edges, and those of its outline. */
  setMesh(
    nodes: Uint16Array<ArrayBuffer>,
    low: number[],
    extent: number[],
    one: number,
    edges: Uint32Array<ArrayBuffer>,
    outline: Uint32Array<ArrayBuffer>,
  ): void;
  /** How far the nodes have moved, as half floats; null if they have not. */
  setMeshMoved(codes: Uint16Array<ArrayBuffer> | null, count: number): void;
  draw(picture: Picture): void;
  /** Waits until all is drawn. */
  finish(): void;
}

/** The clipping plane stands still while the part goes round: n · (R p) > d is (Rᵀ n) · p > d. */
export function turned([a, b, c, d]: Picture["clip"], copy: M3): Picture["clip"] {
  const n = [0, 1, 2].map((j) => a * copy[0][j]! + b * copy[1][j]! + c * copy[2][j]!) as V3;
  return [...n, d];
}

/** The sum over a field's components that is the wished component after a rotation or reflection. Tensors
 * are xx, yy, zz, xy, yz, zx. */
export function weights(shown: Shown, copy: M3): [V3, V3] {
  const none: V3 = [0, 0, 0];
  if (shown.components === 1) return [[1, 0, 0], none];
  if (shown.components === 3) return [copy[shown.component]!, none];
  const PAIRS = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]] as const;
  const [a, b] = PAIRS[shown.component]!;
  const all = PAIRS.map(([i, j]) => {
    const here = copy[a]![i]! * copy[b]![j]!;
    return i === j ? here : here + copy[a]![j]! * copy[b]![i]!;
  });
  return [all.slice(0, 3) as V3, all.slice(3) as V3];
}

