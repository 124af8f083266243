// Draws the springs of a network straight from the module's memory: one instance each, its ends looked up in textures
// that hold all positions, its strain found and coloured by the graphics card.
'use strict';

const VERTEX = `#version 300 es
precision highp float;
precision highp sampler2D;
layout(location = 0) in uvec2 ends;
layout(location = 1) in float restLength;
layout(location = 2) in float plastic;
uniform sampler2D xs, ys;
uniform vec2 centre, scale;   // world metres, clip units per metre
uniform vec2 pixel;           // clip units per pixel
uniform float halfWidth, strainLimit;
out vec3 colour;
out float across;
float at(sampler2D values, uint slot) {
  return texelFetch(values, ivec2(int(slot & 1023u), int(slot >> 10u)), 0).r;
}
void main() {
  vec2 a = vec2(at(xs, ends.x), at(ys, ends.x)), b = vec2(at(xs, ends.y), at(ys, ends.y));
  float side = float(gl_VertexID & 1) * 2.0 - 1.0, end = float(gl_VertexID >> 1);
  vec2 from = (a - centre) * scale / pixel, to = (b - centre) * scale / pixel;
  vec2 along = to - from;
  float drawn = length(along);
  vec2 normal = drawn > 1e-6 ? vec2(-along.y, along.x) / drawn : vec2(0.0);
  gl_Position = vec4(mix(from, to, end) * pixel + normal * side * halfWidth * pixel, 0.0, 1.0);
  if (restLength <= 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // broken
  across = side;
  float strain = clamp((length(b - a) / restLength - 1.0) / strainLimit, -1.0, 1.0);
  float much = sqrt(abs(strain));
  vec3 calm = vec3(0.36, 0.42, 0.50);
  colour = mix(calm, strain < 0.0 ? vec3(0.22, 0.62, 1.0) : vec3(1.0, 0.52, 0.12), much);
  colour = mix(colour, vec3(0.77, 0.36, 1.0), min(1.0, 0.25 + abs(plastic) / 0.04) * float(plastic != 0.0));
}`;

const FRAGMENT = `#version 300 es
precision mediump float;
in vec3 colour;
in float across;
out vec4 shown;
void main() { shown = vec4(colour, 1.0 - smoothstep(0.55, 1.0, abs(across))); }`;

const ROW = 1024; // slots in a row of the textures, as in the shader

function compile(gl, kind, source) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, source);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

class Drawing {
  constructor(canvas) {
    const gl = (this.gl = canvas.getContext('webgl2', { antialias: false, alpha: false, preserveDrawingBuffer: true }));
    if (!gl) throw new Error('this browser has no WebGL 2');
    this.canvas = canvas;
    this.program = gl.createProgram();
    gl.attachShader(this.program, compile(gl, gl.VERTEX_SHADER, VERTEX));
    gl.attachShader(this.program, compile(gl, gl.FRAGMENT_SHADER, FRAGMENT));
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.program));
    this.uniforms = {};
    for (const name of ['xs', 'ys', 'centre', 'scale', 'pixel', 'halfWidth', 'strainLimit'])
      this.uniforms[name] = gl.getUniformLocation(this.program, name);
    this.vertices = gl.createVertexArray();
    this.springs = gl.createBuffer();
    gl.bindVertexArray(this.vertices);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.springs);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribIPointer(0, 2, gl.UNSIGNED_INT, 12, 0);
    gl.vertexAttribDivisor(0, 1);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 1, gl.FLOAT, false, 12, 8);
    gl.vertexAttribDivisor(1, 1);
    this.dents = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.dents);
    gl.enableVertexAttribArray(2);
    gl.vertexAttribPointer(2, 1, gl.FLOAT, false, 4, 0);
    gl.vertexAttribDivisor(2, 1);
    this.textures = [gl.createTexture(), gl.createTexture()];
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    this.slots = 0;
    this.changes = -1;
  }

  // A new network has come: room for its slots.
  start(slots) {
    const gl = this.gl;
    this.slots = slots;
    this.rows = Math.ceil(slots / ROW);
    for (const texture of this.textures) {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32F, ROW, this.rows, 0, gl.RED, gl.FLOAT, null);
      for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    }
    this.changes = -1;
  }

  upload(texture, values) {
    const gl = this.gl, whole = Math.floor(this.slots / ROW), rest = this.slots - whole * ROW;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    if (whole > 0) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, ROW, whole, gl.RED, gl.FLOAT, values, 0);
    if (rest > 0) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, whole, rest, 1, gl.RED, gl.FLOAT, values, whole * ROW);
  }

  // springs: bytes of [count] {slot, slot, rest length}; plastic: [count] how much of it has changed; view: centre in metres relative to the origin, pixels per metre.
  draw(x, y, springs, plastic, changes, view) {
    const gl = this.gl, { width, height } = this.canvas;
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.055, 0.067, 0.086, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.useProgram(this.program);
    if (changes !== this.changes) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.springs);
      gl.bufferData(gl.ARRAY_BUFFER, springs, gl.DYNAMIC_DRAW);
      gl.bindBuffer(gl.ARRAY_BUFFER, this.dents);
      gl.bufferData(gl.ARRAY_BUFFER, plastic, gl.DYNAMIC_DRAW);
      this.changes = changes;
    }
    gl.activeTexture(gl.TEXTURE0);
    this.upload(this.textures[0], x);
    gl.activeTexture(gl.TEXTURE1);
    this.upload(this.textures[1], y);
    gl.uniform1i(this.uniforms.xs, 0);
    gl.uniform1i(this.uniforms.ys, 1);
    gl.uniform2f(this.uniforms.centre, view.x, view.y);
    gl.uniform2f(this.uniforms.scale, (2 * view.scale) / width, (2 * view.scale) / height);
    gl.uniform2f(this.uniforms.pixel, 2 / width, 2 / height);
    gl.uniform1f(this.uniforms.halfWidth, Math.min(4, Math.max(0.75, 0.09 * view.scale)));
    gl.uniform1f(this.uniforms.strainLimit, view.strainLimit);
    gl.bindVertexArray(this.vertices);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, plastic.length);
  }
}
