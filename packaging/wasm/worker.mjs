// SPDX-License-Identifier: BSD-3-Clause
// Draws for a page without stopping it. Each message is a task with an `id`; the answer has the same, and `error` if the
// task failed: { open: { shape } or { files, name } }, then { draw: { width, height, azimuth, elevation, … } }.
import { load } from './rastrum.mjs';

const loading = load();
let scene;

async function open({ shape, files, name }) {
  const rastrum = await loading;
  const begin = performance.now();
  const opened = shape !== undefined ? rastrum.shape(shape) : rastrum.read(files, name);
  scene?.free();
  scene = opened;
  return { primitives: scene.primitives, warnings: scene.warnings, version: rastrum.version,
    milliseconds: performance.now() - begin };
}

async function draw({ width, height, azimuth = 0, elevation = 0, zoom = 1, ...look }) {
  const rastrum = await loading;
  if (scene === undefined) throw new Error('nothing is open yet');
  const camera = rastrum.camera({ fovDegrees: 30 });
  try {
    camera.view('iso', azimuth, elevation).fit(scene, width, height).zoom(zoom);
    const begin = performance.now();
    const picture = rastrum.render(scene, camera, { width, height, ...look });
    return { ...picture, milliseconds: performance.now() - begin, memoryBytes: rastrum.memoryBytes };
  } finally {
    camera.free();
  }
}

onmessage = async ({ data: { id, ...task } }) => {
  try {
    const answer = task.open ? await open(task.open) : await draw(task.draw);
    const images = Object.values(answer).filter(ArrayBuffer.isView);
    postMessage({ id, ...answer }, images.map((image) => image.buffer));
  } catch (error) {
    postMessage({ id, error: error.message });
  }
};
