// A camera that goes round what it looks at.

import { add, cross, dot, lookAt, multiply, perspective, sub, times, unit, type M4, type V3 } from "./space";

/** Height over distance of the picture's edge: 1/tan of half the angle of view. */
const FOCAL = 1 / Math.tan((Math.PI / 180) * 15);

export class Camera {
  target: V3 = [0, 0, 0];
  distance = 1;
  /** Turn about the upward direction, and height above the horizon, rad. */
  turn = 0;
  rise = 0;
  private readonly up: V3;
  private readonly first: V3;
  private readonly second: V3;

  constructor(up: V3) {
    this.up = unit(up);
    const other: V3 = Math.abs(this.up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
    this.second = unit(cross(this.up, other));
    this.first = cross(this.second, this.up);
  }

  /** Looks at a box from a direction that is given by `turn` and `rise`, from so far away that all of it
   * is seen. */
  see(low: V3, high: V3, aspect: number): void {
    this.target = times(add(low, high), 0.5);
    const [right, up, back] = this.axes();
    let distance = 0;
    for (let corner = 0; corner < 8; corner++) {
      const at: V3 = [0, 1, 2].map((d) => (corner & (1 << d) ? high[d]! : low[d]!)) as V3;
      const way = sub(at, this.target);
      const most = Math.max(Math.abs(dot(way, right)) / aspect, Math.abs(dot(way, up))) * FOCAL;
      distance = Math.max(distance, most + dot(way, back));
    }
    this.distance = 1.06 * distance || 1;
  }

  /** Turns so as to look along a direction. */
  lookAlong(v: V3, rise: number): void {
    const back = times(v, -1);
    this.turn = Math.atan2(dot(back, this.second), dot(back, this.first));
    this.rise = rise;
  }

  orbit(turn: number, rise: number): void {
    this.turn += turn;
    this.rise = Math.min(Math.max(this.rise + rise, -Math.PI / 2), Math.PI / 2);
  }

  /** Moves by parts of the picture's height. */
  pan(x: number, y: number): void {
    const [right, up] = this.axes();
    const size = (2 * this.distance) / FOCAL;
    this.target = add(this.target, add(times(right, -x * size), times(up, y * size)));
  }

  zoom(factor: number): void {
    this.distance *= factor;
  }

  axes(): [V3, V3, V3] {
    const [c, s] = [Math.cos(this.rise), Math.sin(this.rise)];
    const level = add(times(this.first, Math.cos(this.turn)), times(this.second, Math.sin(this.turn)));
    const back = add(times(level, c), times(this.up, s));
    const right = cross(this.up, level);
    return [right, cross(back, right), back];
  }

  /** From places in m to the picture; `size` is that of everything, m. */
  matrix(aspect: number, size: number): M4 {
    const [right, up, back] = this.axes();
    const eye = add(this.target, times(back, this.distance));
    const near = Math.max(this.distance - 2 * size, this.distance / 200);
    return multiply(perspective(FOCAL, aspect, near, this.distance + 2 * size), lookAt(eye, right, up, back));
  }

  /** Pixels of something 1 m large at a distance of 1 m, in a picture that is so many pixels high. */
  static pixels(height: number): number {
    return 0.5 * height * FOCAL;
  }
}
