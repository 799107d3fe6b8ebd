// SPDX-License-Identifier: BSD-3-Clause
// What try.py asks of a browser. Each check is a function that throws; the report goes to the server.
import { load, RastrumError } from './rastrum.mjs';

const SIZE = { width: 320, height: 240 };
const text = (words) => new TextEncoder().encode(words);
const report = { passed: [], failed: [], figures: {} };

function equal(is, shouldBe, what) {
  if (is !== shouldBe) throw new Error(`${what}: ${is}, not ${shouldBe}`);
}

/** Draws as the program does with `--look plain`. */
function draw(rastrum, scene, options = {}) {
  const camera = rastrum.camera();
  try {
    return rastrum.render(scene, camera.fit(scene, SIZE.width, SIZE.height), { ...SIZE, ...options });
  } finally {
    camera.free();
  }
}

function drawn(rastrum, scene, options) {
  try {
    return draw(rastrum, scene, options);
  } finally {
    scene.free();
  }
}

/** The options of a line of digests.txt. */
function lookOf(words) {
  const options = {};
  for (let i = 0; i < words.length; i += 2) {
    const name = words[i].slice(2);
    options[name] = name === 'samples' || name === 'opacity' ? Number(words[i + 1]) : words[i + 1];
  }
  return options;
}

const corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
const positions = Float32Array.from(corners.flat()), indices = Uint32Array.from(faces.flat());
const OBJ = text(`${corners.map((c) => `v ${c.join(' ')}`).join('\n')}\n${faces.map((f) => `f ${f.map((i) => i + 1).join(' ')}`).join('\n')}\n`);

/** The tetrahedron in each format; all must give one picture. */
function tetrahedra() {
  const lines = (rows) => rows.map((row) => row.join(' ')).join('\n');
  const buffer = new Uint8Array([...new Uint8Array(positions.buffer), ...new Uint8Array(indices.buffer)]);
  const gltf = {
    asset: { version: '2.0' }, buffers: [{ uri: 'data/t.bin', byteLength: buffer.length }],
    bufferViews: [{ buffer: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 48 }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 1] },
      { bufferView: 1, componentType: 5125, count: 12, type: 'SCALAR' }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }], nodes: [{ mesh: 0 }], scenes: [{ nodes: [0] }], scene: 0,
  };
  return {
    't.obj': { 't.obj': OBJ },
    't.off': { 't.off': text(`OFF\n4 4 0\n${lines(corners)}\n${lines(faces.map((f) => [3, ...f]))}\n`) },
    't.ply': { 't.ply': text(`ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n${lines(corners)}\n${lines(faces.map((f) => [3, ...f]))}\n`) },
    't.stl': { 't.stl': text(`solid t\n${faces.map((f) => `facet normal 0 0 0\nouter loop\n${f.map((i) => `vertex ${corners[i].join(' ')}`).join('\n')}\nendloop\nendfacet`).join('\n')}\nendsolid t\n`) },
    't.gltf': { 't.gltf': text(JSON.stringify(gltf)), 'data/t.bin': buffer },
  };
}

const checks = {
  async pictures(rastrum, { digests }) {
    for (const line of digests) {
      const [digest, shape, ...look] = line.split(/ +/);
      equal(drawn(rastrum, rastrum.shape(shape), { ...lookOf(look), digests: ['color8'] }).digests.color8, digest, line);
      report.passed.push(line.slice(66));
    }
  },

  async formats(rastrum) {
    const scene = rastrum.scene();
    equal(scene.addMesh(positions, indices), 0, 'the number of the first instance');
    const targets = ['color8', 'depth', 'ids'], look = { shader: 'phong', targets, digests: targets };
    const { digests } = drawn(rastrum, scene, look);
    for (const [name, files] of Object.entries(tetrahedra())) {
      const read = drawn(rastrum, rastrum.read(files, name), look);
      for (const target of targets) equal(read.digests[target], digests[target], `${name}, ${target}`);
    }
  },

  async errors(rastrum) {
    const refused = (f, words, status) => {
      try {
        f();
      } catch (error) {
        if (!(error instanceof RastrumError) || !error.message.includes(words)) throw error;
        equal(error.status, status, `${words}: the status`);
        return report.passed.push(error.message);
      }
      throw new Error(`not refused: ${words}`);
    };
    refused(() => rastrum.read({ 'broken.obj': text('v 0 0 0\nf 1 2 3\n') }, 'broken.obj'), 'broken.obj:2', 4);
    refused(() => rastrum.read({ 'short.ply': text('ply\nformat ascii 1.0\n') }, 'short.ply'), 'short.ply', 4);
    refused(() => rastrum.read({ 't.gltf': tetrahedra()['t.gltf']['t.gltf'] }, 't.gltf'), 't.bin', 2);
    refused(() => rastrum.read({}, 'none.obj'), 'none.obj', 2);
    refused(() => rastrum.read({ 'p.glb': new Uint8Array(100) }, 'p.glb'), 'p.glb', 4);
    refused(() => rastrum.shape('teapott'), 'teapott', 1);
    const scene = rastrum.scene();
    scene.addMesh(positions, Uint32Array.of(0, 1, 7));
    refused(() => drawn(rastrum, scene), '7', 1);
    refused(() => rastrum.scene().addMesh(positions, indices, { per: 'face', colors: new Float32Array(5) }), 'colors', 1);
    refused(() => rastrum.camera({ eye: [1, 2] }), '2 numbers', 1);
  },

  // A texture, which goes through libpng: a picture of one pixel.
  async textures(rastrum) {
    const png = Uint8Array.from(atob('iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg=='), (c) => c.charCodeAt(0));
    const obj = text(`mtllib m.mtl\nvt 0 0\n${new TextDecoder().decode(OBJ).replace('f ', 'usemtl red\nf ').replace(/f (\d) (\d) (\d)/g, 'f $1/1 $2/1 $3/1')}`);
    const files = { 'm.obj': obj, 'm.mtl': text('newmtl red\nmap_Kd red.png\n'), 'red.png': png };
    const scene = rastrum.read(files, 'm.obj');
    equal(scene.warnings.join(), '', 'warnings');
    const { color8 } = drawn(rastrum, scene, { shader: 'material' });
    const i = 4 * (120 * SIZE.width + 160);
    if (!(color8[i] > 50 && color8[i + 1] < color8[i] / 4)) throw new Error(`the texture is not red: ${color8.slice(i, i + 4)}`);
    const broken = rastrum.read({ ...files, 'red.png': png.slice(0, 40) }, 'm.obj');
    if (!broken.warnings.join().includes('red.png')) throw new Error(`a broken texture: ${broken.warnings}`);
    broken.free();
  },

  async memory(rastrum) {
    const files = { 'm.obj': text(new TextDecoder().decode(OBJ).repeat(10000)) };
    const load = () => {
      rastrum.read(files, 'm.obj').free();
      drawn(rastrum, rastrum.shape('teapot'));
    };
    for (let i = 0; i < 5; ++i) load();
    const before = rastrum.memoryBytes;
    for (let i = 0; i < 100; ++i) load();
    report.figures.memoryMiB = rastrum.memoryBytes / 2 ** 20;
    equal(rastrum.memoryBytes, before, 'bytes after 100 loads');
  },

  // Frames of files that the server has, as medians, in ms.
  async figures(rastrum, { figures }) {
    for (const name of figures) {
      const bytes = new Uint8Array(await (await fetch(`/data/${name}`)).arrayBuffer());
      const begin = performance.now();
      const scene = rastrum.read({ [name]: bytes }, name);
      const read = performance.now() - begin;
      const camera = rastrum.camera({ fovDegrees: 30 }).view('iso').fit(scene, 800, 600);
      const times = [];
      for (let i = 0; i < 21; ++i) {
        const start = performance.now();
        rastrum.render(scene, camera, { width: 800, height: 600, shader: 'phong' });
        times.push(performance.now() - start);
      }
      const picture = rastrum.render(scene, camera, { width: 800, height: 600, shader: 'phong', digests: ['color8'] });
      report.figures[name] = { read, frame: times.sort((a, b) => a - b)[10], digest: picture.digests.color8, primitives: scene.primitives };
      camera.free();
      scene.free();
    }
  },
};

const task = await (await fetch('/task')).json();
try {
  const rastrum = await load();
  report.figures.version = rastrum.version;
  for (const [name, check] of Object.entries(checks)) {
    const begin = performance.now();
    try {
      await check(rastrum, task);
      report.passed.push(name);
    } catch (error) {
      report.failed.push(`${name}: ${error.stack ?? error}`);
    }
    report.figures[`${name} took`] = `${(performance.now() - begin).toFixed(0)} ms`;
  }
} catch (error) {
  report.failed.push(`${error.stack ?? error}`);
}
await fetch('/report', { method: 'POST', body: JSON.stringify(report) });
