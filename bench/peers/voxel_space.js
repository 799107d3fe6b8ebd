// The peer of `rastrum bench paper3`: the original program's frame as node runs it, written from
// its rules (docs/terrain_rules.md), one thread.
//
// usage: node voxel_space.js MAP WIDTH HEIGHT DISTANCE
// MAP: 1024² altitudes, a byte each, then as many colours of 4 bytes. Prints the FNV-1a hash of the
// default camera's frame; then, for each line it reads, draws frames for 30 ms (one at least, after
// one that is not counted) and prints their median in ms.
'use strict';
const fs = require('fs');

const [file, width_arg, height_arg, distance_arg] = process.argv.slice(2);
const W = Number(width_arg), H = Number(height_arg);
const bytes = fs.readFileSync(file);
const cells = 1024 * 1024;
const altitude = new Uint8Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + cells));
const color = new Uint32Array(
  bytes.buffer.slice(bytes.byteOffset + cells, bytes.byteOffset + 5 * cells));
const camera = {x: 512, y: 800, height: 78, angle: 0, horizon: 100, distance: Number(distance_arg)};
const pixels = new Uint32Array(W * H);
const hidden = new Int32Array(W);

function drawVerticalLine(x, top, bottom, c) {
  x = x | 0;
  top = top | 0;
  bottom = bottom | 0;
  if (top < 0) top = 0;
  if (top > bottom) return;
  let at = (top * W + x) | 0;
  for (let y = top; y < bottom; y = (y + 1) | 0) {
    pixels[at] = c;
    at = (at + W) | 0;
  }
}

function frame() {
  const ground = altitude[((Math.floor(camera.y) & 1023) << 10) + (Math.floor(camera.x) & 1023)];
  if (ground + 10 > camera.height) camera.height = ground + 10;
  pixels.fill(0xFFE09090 | 0);
  hidden.fill(H);
  const sin = Math.sin(camera.angle), cos = Math.cos(camera.angle);
  let dz = 1;
  for (let z = 1; z < camera.distance; z += dz) {
    let x = -cos * z - sin * z, y = sin * z - cos * z;
    const dx = (cos * z - sin * z - x) / W, dy = (-sin * z - cos * z - y) / W;
    x += camera.x;
    y += camera.y;
    const inverse = 1 / z * 240;
    for (let i = 0; i < W; i = (i + 1) | 0) {
      const at = ((Math.floor(y) & 1023) << 10) + (Math.floor(x) & 1023) | 0;
      const top = ((camera.height - altitude[at]) * inverse + camera.horizon) | 0;
      drawVerticalLine(i, top, hidden[i], color[at]);
      if (top < hidden[i]) hidden[i] = top;
      x += dx;
      y += dy;
    }
    dz += 0.005;
  }
}

frame();
let hash = 0xcbf29ce484222325n;
for (let i = 0; i < pixels.length; ++i)
  hash = BigInt.asUintN(64, (hash ^ BigInt(pixels[i])) * 0x100000001b3n);
console.log(hash.toString(16));

function turn() {
  frame();
  const times = [];
  for (const began = performance.now(); times.length === 0 || performance.now() - began < 30;) {
    const start = performance.now();
    frame();
    times.push(performance.now() - start);
  }
  times.sort((a, b) => a - b);
  return times[times.length >> 1];
}

require('readline').createInterface({input: process.stdin}).on('line', () => {
  console.log(turn());
});
