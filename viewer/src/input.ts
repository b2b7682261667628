// Mouse, fingers and keys on the picture.

export interface Commands {
  /** rad. */
  turn(x: number, y: number): void;
  /** Parts of the picture's height. */
  pan(x: number, y: number): void;
  zoom(factor: number): void;
  /** A click at a place, CSS pixels. */
  pick(x: number, y: number): void;
  /** Whether the key means something. */
  key(key: string): boolean;
}

/** A pointer that moves less than this, pixels, clicks. */
const STILL = 4;

export function attach(canvas: HTMLCanvasElement, commands: Commands): void {
  const fingers = new Map<number, { x: number; y: number }>();
  let way = 0;
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    way = fingers.size > 1 ? Infinity : 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const [x, y] = [event.clientX - before.x, event.clientY - before.y];
    const height = canvas.clientHeight || 1;
    way += Math.abs(x) + Math.abs(y);
    const apart = spread();
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (fingers.size > 1) {
      if (apart > 0 && spread() > 0) commands.zoom(apart / spread());
      commands.pan(x / height / 2, y / height / 2);
    } else if (event.shiftKey || event.buttons & 6) {
      commands.pan(x / height, y / height);
    } else if (way > STILL) {
      commands.turn((-4 * x) / height, (4 * y) / height);
    }
  });
  const end = (event: PointerEvent) => {
    if (!fingers.delete(event.pointerId) || event.type !== "pointerup" || way > STILL) return;
    const box = canvas.getBoundingClientRect();
    commands.pick(event.clientX - box.left, event.clientY - box.top);
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      // Without a key the wheel belongs to the page, unless the picture has been clicked.
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      commands.zoom(Math.exp(0.0015 * event.deltaY));
    },
    { passive: false },
  );
  canvas.addEventListener("keydown", (event) => {
    const arrows: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, -1],
      ArrowDown: [0, 1],
    };
    const arrow = arrows[event.key];
    if (arrow && event.shiftKey) commands.pan(-0.05 * arrow[0], -0.05 * arrow[1]);
    else if (arrow) commands.turn(0.1 * arrow[0], -0.1 * arrow[1]);
    else if (event.key === "+" || event.key === "=") commands.zoom(1 / 1.15);
    else if (event.key === "-") commands.zoom(1.15);
    else if (event.ctrlKey || event.metaKey || !commands.key(event.key)) return;
    event.preventDefault();
  });
}
