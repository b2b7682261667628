// Processor time of a picture of 200,000 particles at 800 × 600, drawn without a graphics processor, and without a
// browser, so that whatever else the machine does counts less: node tests/cost.mjs
import { build } from "esbuild";

const source = `
export { Software } from "./src/software";
export { Camera } from "./src/camera";
export { IDENTITY } from "./src/space";
`;
const here = new URL("..", import.meta.url).pathname;
const made = await build({ stdin: { contents: source, resolveDir: here, loader: "ts" }, bundle: true, format: "esm", write: false });
const { Software, Camera, IDENTITY } = await import(`data:text/javascript;base64,${Buffer.from(made.outputFiles[0].text).toString("base64")}`);

globalThis.ImageData = class {
  constructor(width, height) {
    Object.assign(this, { width, height, data: new Uint8ClampedArray(4 * width * height) });
  }
};
const canvas = { width: 800, height: 600, getContext: () => ({ putImageData() {} }) };
const software = new Software(canvas);

// A block of 60 × 60 × 56 particles, a little out of order, as they are in elements.
const [n, count] = [60, 60 * 60 * 56];
let seed = 1;
const random = () => ((seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32);
const origins = new Uint16Array(3 * count);
for (let i = 0; i < count; i++) {
  const cell = [i % n, Math.floor(i / n) % n, Math.floor(i / n / n)];
  cell.forEach((k, d) => (origins[3 * i + d] = (65535 * (k + random())) / n));
}
software.setOrigins(origins, [0, 0, 0], [20, 20, 20]);
software.setMoved(new Uint16Array(3 * count), 1);
software.setSizes(new Float32Array(count).fill(20 / n));
const codes = Uint16Array.from({ length: 3 * count }, () => 0x3000 + 2000 * random());
software.setShown({ codes, components: 3, kinds: false, whole: true, component: 0, range: [0, 1], palette: new Uint8Array(1024) });
const camera = new Camera([0, 0, 1]);
camera.lookAlong([0.5, 0.8, 0], 0.4);
camera.see([0, 0, 0], [20, 20, 20 * 56 / 60], 800 / 600);
const draw = () => {
  camera.orbit(0.05, 0);
  software.draw({
    view: camera.matrix(800 / 600, 35),
    copies: [IDENTITY],
    magnified: 1,
    blown: 0.85,
    clip: [0, 0, 0, 1],
    background: [1, 1, 1],
    ink: [0, 0, 0],
    edges: 0.12,
    outline: true,
  });
};
for (let i = 0; i < 20; i++) draw();
const before = process.cpuUsage();
const begun = performance.now();
const pictures = 60;
for (let i = 0; i < pictures; i++) draw();
const { user, system } = process.cpuUsage(before);
const wall = (performance.now() - begun) / pictures;
console.log(`${count} particles at 800 × 600: ${((user + system) / 1000 / pictures).toFixed(1)} ms of processor time a picture, ${wall.toFixed(1)} ms by the clock`);
