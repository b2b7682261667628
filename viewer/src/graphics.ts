// Draws with WebGL 2. Nothing is computed per particle here: positions,
// values and colours are made of the packed arrays by the graphics processor.

import { Camera } from "./camera";
import { LEAST, turned, weights, type Picture, type Renderer, type Shown } from "./picture";
import { matrix, multiply } from "./space";

const PARTICLES = `#version 300 es
precision highp float;
in vec3 origin;
in vec3 moved;
in vec3 first;
in vec3 second;
in float size;
uniform mat4 view;
uniform vec3 low, extent;
uniform float one, magnified, pixels, least, most;
uniform vec3 weights1, weights2;
uniform bool whole;
uniform vec2 range;
uniform vec4 clip;
uniform sampler2D palette;
flat out vec3 colour;
flat out float wide;
void main() {
  vec3 place = low + extent * origin + magnified * one * moved;
  float value = whole ? length(first) : dot(weights1, first) + dot(weights2, second);
  float share = clamp((value - range.x) * range.y, 0.0, 1.0);
  colour = textureLod(palette, vec2((share * 255.0 + 0.5) / 256.0, 0.5), 0.0).rgb;
  gl_Position = view * vec4(place, 1.0);
  wide = clamp(pixels * size / gl_Position.w, least, most);
  gl_PointSize = wide;
  // Far outside the picture, and so not drawn.
  if (size <= 0.0 || dot(clip.xyz, place) > clip.w) gl_Position = vec4(0.0, 0.0, 9.0, 1.0);
}`;

const BALL = `#version 300 es
precision mediump float;
flat in vec3 colour;
flat in float wide;
out vec4 pixel;
void main() {
  vec2 at = 2.0 * gl_PointCoord - 1.0;
  float square = dot(at, at);
  // Small ones are drawn as they are: no one sees that they are not round.
  if (wide > 3.0 && square > 1.0) discard;
  float depth = sqrt(max(1.0 - square, 0.0));
  float light = wide > 3.0 ? 0.52 + 0.5 * (0.35 * at.x * -1.0 + -0.4 * at.y + 0.8 * depth) : 0.8;
  pixel = vec4(colour * min(light, 1.06), 1.0);
}`;

const LINES = `#version 300 es
precision highp float;
in vec3 origin;
in vec3 moved;
uniform mat4 view;
uniform vec3 low, extent;
uniform float one;
void main() {
  gl_Position = view * vec4(low + extent * origin + one * moved, 1.0);
}`;

const FLAT = `#version 300 es
precision mediump float;
uniform vec4 ink;
out vec4 pixel;
void main() { pixel = ink; }`;

export class Graphics implements Renderer {
  private readonly gl: WebGL2RenderingContext;
  private readonly particles: Program;
  private readonly lines: Program;
  private readonly buffers = new Map<string, WebGLBuffer>();
  private readonly texture: WebGLTexture;
  private count = 0;
  private shown: Shown | null = null;
  private place = { low: [0, 0, 0], extent: [1, 1, 1], one: 1 };
  private mesh: { low: number[]; extent: number[]; one: number; edges: number; outline: number } | null = null;

  constructor(readonly canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false });
    if (!gl) throw new Error("this browser does not offer WebGL 2");
    this.gl = gl;
    this.particles = new Program(gl, PARTICLES, BALL);
    this.lines = new Program(gl, LINES, FLAT);
    this.texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    for (const [key, value] of [
      [gl.TEXTURE_MIN_FILTER, gl.NEAREST],
      [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE],
      [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
    ] as const) {
      gl.texParameteri(gl.TEXTURE_2D, key, value);
    }
  }

  private fill(name: string, data: Uint16Array<ArrayBuffer> | Float32Array<ArrayBuffer> | Uint32Array<ArrayBuffer>, target?: number): void {
    const gl = this.gl;
    let buffer = this.buffers.get(name);
    if (!buffer) {
      buffer = gl.createBuffer()!;
      this.buffers.set(name, buffer);
    }
    gl.bindBuffer(target ?? gl.ARRAY_BUFFER, buffer);
    gl.bufferData(target ?? gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
  }

  /** Where displacements count from, as parts of a box. */
  setOrigins(codes: Uint16Array<ArrayBuffer>, low: number[], extent: number[]): void {
    this.fill("origins", codes);
    this.count = codes.length / 3;
    this.place = { ...this.place, low, extent };
  }

  /** Displacements as half floats of `one`. */
  setMoved(codes: Uint16Array<ArrayBuffer>, one: number): void {
    this.fill("moved", codes);
    this.place.one = one;
  }

  /** Diameters, m; 0 for what is not there. */
  setSizes(sizes: Float32Array<ArrayBuffer>): void {
    this.fill("sizes", sizes);
  }

  setShown(shown: Shown): void {
    this.fill("shown", shown.kinds ? Float32Array.from(shown.codes) : shown.codes);
    this.setColours(shown);
  }

  /** The same field with other colours. */
  setColours(shown: Shown): void {
    const gl = this.gl;
    this.shown = shown;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, shown.palette);
  }

  /** Nodes of the surface as parts of a box, and pairs of them: all edges, and those of its outline. */
  setMesh(
    nodes: Uint16Array<ArrayBuffer>,
    low: number[],
    extent: number[],
    one: number,
    edges: Uint32Array<ArrayBuffer>,
    outline: Uint32Array<ArrayBuffer>,
  ): void {
    this.fill("nodes", nodes);
    this.fill("nodes-moved", new Uint16Array(nodes.length));
    this.fill("edges", edges, this.gl.ELEMENT_ARRAY_BUFFER);
    this.fill("outline", outline, this.gl.ELEMENT_ARRAY_BUFFER);
    this.mesh = { low, extent, one, edges: edges.length, outline: outline.length };
  }

  /** How far the nodes have moved, as half floats; null if they have not. */
  setMeshMoved(codes: Uint16Array<ArrayBuffer> | null, count: number): void {
    this.fill("nodes-moved", codes ?? new Uint16Array(3 * count));
  }

  draw(picture: Picture): void {
    const gl = this.gl;
    const { width, height } = this.canvas;
    gl.viewport(0, 0, width, height);
    gl.clearColor(...picture.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    if (this.shown && this.count) this.drawParticles(picture, this.shown, height);
    if (this.mesh) this.drawMesh(picture, this.mesh);
  }

  private drawParticles(picture: Picture, shown: Shown, height: number): void {
    const gl = this.gl;
    const program = this.particles;
    program.use();
    this.attribute(program, "origin", "origins", 3, gl.UNSIGNED_SHORT, true, 0, 0);
    this.attribute(program, "moved", "moved", 3, gl.HALF_FLOAT, false, 0, 0);
    this.attribute(program, "size", "sizes", 1, gl.FLOAT, false, 0, 0);
    const type = shown.kinds ? gl.FLOAT : gl.HALF_FLOAT;
    const stride = shown.components * (shown.kinds ? 4 : 2);
    this.attribute(program, "first", "shown", Math.min(shown.components, 3), type, false, stride, 0);
    if (shown.components === 6) {
      this.attribute(program, "second", "shown", 3, type, false, stride, 6);
    } else {
      program.none("second");
    }
    const [low, high] = shown.range;
    gl.uniform3fv(program.at("low"), this.place.low);
    gl.uniform3fv(program.at("extent"), this.place.extent);
    gl.uniform1f(program.at("one"), this.place.one);
    gl.uniform1f(program.at("magnified"), picture.magnified);
    gl.uniform1f(program.at("pixels"), Camera.pixels(height) * picture.blown);
    gl.uniform1f(program.at("least"), LEAST);
    gl.uniform1f(program.at("most"), Math.min(64, gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE)[1]));
    gl.uniform1i(program.at("whole"), shown.whole ? 1 : 0);
    gl.uniform2f(program.at("range"), low, high > low ? 1 / (high - low) : 0);
    gl.uniform1i(program.at("palette"), 0);
    for (const copy of picture.copies) {
      const [first, second] = weights(shown, copy);
      gl.uniform3fv(program.at("weights1"), first);
      gl.uniform3fv(program.at("weights2"), second);
      gl.uniformMatrix4fv(program.at("view"), false, multiply(picture.view, matrix(copy)));
      gl.uniform4fv(program.at("clip"), turned(picture.clip, copy));
      gl.drawArrays(gl.POINTS, 0, this.count);
    }
  }

  private drawMesh(picture: Picture, mesh: NonNullable<Graphics["mesh"]>): void {
    const gl = this.gl;
    const program = this.lines;
    program.use();
    this.attribute(program, "origin", "nodes", 3, gl.UNSIGNED_SHORT, true, 0, 0);
    this.attribute(program, "moved", "nodes-moved", 3, gl.HALF_FLOAT, false, 0, 0);
    gl.uniform3fv(program.at("low"), mesh.low);
    gl.uniform3fv(program.at("extent"), mesh.extent);
    gl.uniform1f(program.at("one"), mesh.one);
    gl.uniformMatrix4fv(program.at("view"), false, picture.view);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    const lines = (name: string, count: number, alpha: number) => {
      if (!count || !alpha) return;
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffers.get(name)!);
      gl.uniform4f(program.at("ink"), ...picture.ink, alpha);
      gl.drawElements(gl.LINES, count, gl.UNSIGNED_INT, 0);
    };
    lines("edges", mesh.edges, picture.edges);
    lines("outline", mesh.outline, picture.outline ? 0.55 : 0);
    gl.depthMask(true);
  }

  private attribute(
    program: Program,
    name: string,
    buffer: string,
    components: number,
    type: number,
    normalised: boolean,
    stride: number,
    offset: number,
  ): void {
    const gl = this.gl;
    const at = program.attribute(name);
    if (at < 0) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.get(buffer)!);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, components, type, normalised, stride, offset);
  }

  finish(): void {
    const gl = this.gl;
    const pixel = new Uint8Array(4);
    gl.readPixels(this.canvas.width >> 1, this.canvas.height >> 1, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  }
}

class Program {
  private readonly program: WebGLProgram;
  private readonly places = new Map<string, WebGLUniformLocation | null>();

  constructor(private readonly gl: WebGL2RenderingContext, vertex: string, fragment: string) {
    const program = gl.createProgram()!;
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
      const shader = gl.createShader(type)!;
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) ?? "no program");
    this.program = program;
  }

  use(): void {
    const gl = this.gl;
    for (let i = 0; i < 8; i++) gl.disableVertexAttribArray(i);
    gl.useProgram(this.program);
  }

  at(name: string): WebGLUniformLocation | null {
    if (!this.places.has(name)) this.places.set(name, this.gl.getUniformLocation(this.program, name));
    return this.places.get(name)!;
  }

  attribute(name: string): number {
    return this.gl.getAttribLocation(this.program, name);
  }

  /** The attribute is zero for all. */
  none(name: string): void {
    const at = this.attribute(name);
    if (at >= 0) this.gl.vertexAttrib3f(at, 0, 0, 0);
  }
}
