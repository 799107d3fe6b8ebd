// SPDX-License-Identifier: BSD-3-Clause
// Rastrum in JavaScript: the functions of rastrum.h with arrays and strings of JavaScript. The same scene gives the same
// bytes as everywhere else. rastrum.d.ts has the types, docs/browser.md is the guide.
import { plain, Wasi } from './wasi.mjs';

const NUMBERS = [Float32Array, Float64Array, Uint8Array, Int8Array, Uint16Array, Int16Array, Uint32Array, Int32Array,
  BigUint64Array, BigInt64Array]; // in the order of RASTRUM_FLOAT32, …
const PER = { vertex: 0, corner: 1, face: 2, mesh: 3 };

/** The array as `count` numbers. */
function numbers(Numbers, array, count, name) {
  if (array.length !== count) throw new RastrumError(`${name}: ${array.length} numbers, not ${count}`, 1);
  return Numbers.from(array);
}

/** A failure; `status` is that of rastrum.h. */
export class RastrumError extends Error {
  constructor(message, status) {
    super(message);
    this.name = 'RastrumError';
    this.status = status;
  }
}

/** Loads the module: from an address, a Response, or its bytes. */
export async function load(source = new URL('rastrum.wasm', import.meta.url)) {
  const wasi = new Wasi();
  const imports = { wasi_snapshot_preview1: wasi.imports };
  if (typeof source === 'string' || source instanceof URL) source = await fetch(source);
  if (source instanceof Response) {
    if (!source.ok) throw new RastrumError(`${source.url}: cannot be loaded (${source.status})`, 3);
    source = await source.arrayBuffer();
  }
  const { instance } = await WebAssembly.instantiate(source, imports);
  wasi.memory = instance.exports.memory;
  instance.exports._initialize();
  return new Rastrum(instance.exports, wasi);
}

class Rastrum {
  #c; #wasi; #renderer;

  constructor(exports, wasi) {
    this.#c = exports;
    this.#wasi = wasi;
    this.#renderer = exports.rastrum_renderer_new();
    this._call('rastrum_renderer_set_threads', this.#renderer, 1); // WebAssembly starts none
    this.version = this._text(exports.rastrum_version());
  }

  /** Bytes of the module's memory, which grows and never shrinks. */
  get memoryBytes() { return this.#c.memory.buffer.byteLength; }

  /** Reads the file `name` of `files`, an object or Map from names to Uint8Arrays, beside which its companions lie.
   * Edges sharper than `creaseDegrees` stay sharp where a mesh has no normals. */
  read(files, name, { creaseDegrees = 40 } = {}) {
    const given = files instanceof Map ? files : new Map(Object.entries(files));
    for (const [file, bytes] of given)
      if (!(bytes instanceof Uint8Array)) throw new RastrumError(`${file}: its bytes must be a Uint8Array`, 1);
    this.#wasi.files = new Map([...given].map(([file, bytes]) => [plain(file), bytes]));
    try {
      return new Scene(this, this._made('rastrum_wasm_read', `/${plain(name)}`, creaseDegrees), true);
    } finally {
      this.#wasi.files = new Map();
    }
  }

  /** Makes a shape: `teapot`, `boxes?count=8`, … */
  shape(spec) { return new Scene(this, this._made('rastrum_wasm_shape', spec), true); }

  /** A scene without anything, for arrays. */
  scene() { return new Scene(this, this._made('rastrum_scene_new')); }

  camera(options = {}) { return new Camera(this, this._made('rastrum_camera_new'), options); }

  /** Draws a picture, and returns its images by their names (docs/outputs.md). `digests` names those whose digests are made, too. */
  render(scene, camera, { width, height, targets = ['color8'], digests = [], shader, background, samples, opacity, shadows, cull,
    lights = [] }) {
    const frame = this._made('rastrum_frame_new', width, height);
    const places = [];
    try {
      const set = (name, ...values) => this._call(`rastrum_frame_${name}`, frame, ...values);
      if (shader !== undefined) set('set_shader', shader);
      if (background !== undefined) set('set_background', numbers(Float32Array, background, 4, 'background'));
      if (samples !== undefined) set('set_samples', Number(samples));
      if (opacity !== undefined) set('set_opacity', Number(opacity));
      if (shadows !== undefined) set('set_shadows', shadows ? 1 : 0);
      if (cull !== undefined) set('set_cull', ['none', 'back', 'front'].indexOf(cull));
      if (lights === 'studio') this._call('rastrum_wasm_add_studio', frame);
      else for (const l of lights)
        set('add_light', ['ambient', 'directional', 'point'].indexOf(l.kind), l.vector && numbers(Float64Array, l.vector, 3, 'vector'),
          numbers(Float32Array, l.color ?? [1, 1, 1], 3, 'color'), l.intensity ?? 1, l.ofCamera ? 1 : 0);
      for (const target of targets) {
        const [type, channels] = this._target(target);
        const bytes = width * height * channels * NUMBERS[type].BYTES_PER_ELEMENT;
        const place = { target, type, bytes, at: this._allocate(bytes) };
        places.push(place);
        set('set_target', target, place.at, bytes, 0);
      }
      this._call('rastrum_render', this.#renderer, scene.handle, camera.handle, frame);
      const picture = { width, height, digests: {} };
      for (const { target, type, bytes, at } of places) {
        const Numbers = target === 'color8' ? Uint8ClampedArray : NUMBERS[type];
        picture[target] = new Numbers(this.#c.memory.buffer.slice(at, at + bytes));
      }
      for (const target of digests) {
        const digest = this._allocate(65);
        try {
          set('digest', target, digest);
          picture.digests[target] = this._text(digest);
        } finally {
          this._free(digest);
        }
      }
      return picture;
    } finally {
      this.#c.rastrum_frame_free(frame);
      for (const { at } of places) this._free(at);
    }
  }

  // What the classes below share.

  _text(at) {
    const bytes = new Uint8Array(this.#c.memory.buffer, at >>> 0);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  _allocate(bytes) {
    const at = this.#c.malloc(Math.max(bytes, 1)) >>> 0;
    if (at === 0) throw new RastrumError(`there is no memory for ${bytes} bytes`, 6);
    return at;
  }

  _free(at) { this.#c.free(at); }

  /** Copies an array into the module's memory. */
  _copy(array) {
    const at = this._allocate(array.byteLength);
    new Uint8Array(this.#c.memory.buffer, at, array.byteLength)
      .set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength));
    return at;
  }

  /** Calls a function with numbers, and with strings and arrays that it sees during the call alone. */
  _value(name, args) {
    const copies = [];
    try {
      return this.#c[name](...args.map((value) => {
        if (value === undefined || value === null) return 0;
        if (typeof value === 'number') return value;
        const array = typeof value === 'string' ? new TextEncoder().encode(`${value}\0`) : value;
        if (!ArrayBuffer.isView(array)) throw new RastrumError(`${name}: cannot take ${value}`, 1);
        copies.push(this._copy(array));
        return copies.at(-1);
      }));
    } finally {
      for (const at of copies) this._free(at);
    }
  }

  _call(name, ...args) {
    const status = this._value(name, args);
    if (status !== 0) throw new RastrumError(this._text(this.#c.rastrum_error_text()), status);
  }

  /** Calls a function that makes a handle. */
  _made(name, ...args) {
    const handle = this._value(name, args);
    if (handle === 0) throw new RastrumError(this._text(this.#c.rastrum_error_text()), this.#c.rastrum_error_status());
    return handle;
  }

  _target(name) {
    const out = this._allocate(8);
    try {
      this._call('rastrum_target_type', name, out, out + 4);
      return this._numbers(out, 2);
    } finally {
      this._free(out);
    }
  }

  _numbers(at, count) { return [...new Int32Array(this.#c.memory.buffer, at, count)]; }

  _plain(name, ...args) { return this.#c[name](...args); }
}

/** What is drawn. Its arrays are copies; free() gives the memory back. */
class Scene {
  #rastrum; #arrays = []; #isRead;

  constructor(rastrum, handle, isRead = false) {
    this.#rastrum = rastrum;
    this.#isRead = isRead;
    this.handle = handle;
  }

  /** What the reader left out or found odd, a sentence each. */
  get warnings() {
    const all = [];
    for (let at; (at = this.#rastrum._plain('rastrum_wasm_warning', this.handle, all.length)) !== 0;)
      all.push(this.#rastrum._text(at));
    return all;
  }

  /** Triangles and other primitives of a file or a shape. */
  get primitives() { return this.#rastrum._plain('rastrum_wasm_primitives', this.handle); }

  /** Adds triangles, by indices or three positions each, and returns the number of the instance. */
  addMesh(positions, indices, { normals, colors, per = 'vertex', color, opacity, transform } = {}) {
    if (this.#isRead) throw new RastrumError('a scene of a file or a shape takes no meshes', 1);
    const out = this.#rastrum._allocate(4);
    let instance;
    try {
      this.#rastrum._call('rastrum_scene_add_mesh', this.handle, this.#array(positions, 3), this.#array(indices, 1), out);
      instance = this.#rastrum._numbers(out, 1)[0];
    } finally {
      this.#rastrum._free(out);
    }
    const set = (what, ...values) => this.#rastrum._call(`rastrum_instance_set_${what}`, this.handle, instance, ...values);
    if (normals) set('normals', this.#array(normals, 3), PER[per]);
    if (colors) {
      const vertices = positions.length / 3, corners = indices?.length ?? vertices;
      const channels = colors.length / { vertex: vertices, corner: corners, face: corners / 3, mesh: 1 }[per];
      if (channels !== 3 && channels !== 4) throw new RastrumError(`colors: ${colors.length} numbers, not 3 or 4 for each ${per}`, 1);
      set('colors', this.#array(colors, channels), PER[per]);
    }
    if (color) set('color', numbers(Float32Array, color, 4, 'color'));
    if (opacity !== undefined) set('opacity', opacity);
    if (transform) set('transform', numbers(Float64Array, transform, 16, 'transform'));
    return instance;
  }

  /** A rastrum_array of a copy that lives as long as the scene. */
  #array(array, channels) {
    if (!array) return new Uint32Array(5);
    const type = NUMBERS.findIndex((Numbers) => array instanceof Numbers);
    if (type < 0) throw new RastrumError('arrays must be typed, as Float32Array and Uint32Array are', 1);
    this.#arrays.push(this.#rastrum._copy(array));
    return Uint32Array.of(this.#arrays.at(-1), array.length / channels, type, channels, 0);
  }

  free() {
    this.#rastrum._plain('rastrum_scene_free', this.handle);
    for (const at of this.#arrays) this.#rastrum._free(at);
    this.#arrays = [];
    this.handle = 0;
  }
}

/** Where a picture is seen from. */
class Camera {
  #rastrum;

  constructor(rastrum, handle, { eye, target = [0, 0, 0], up = [0, 1, 0], fovDegrees }) {
    this.#rastrum = rastrum;
    this.handle = handle;
    try {
      if (eye) this.#call('rastrum_camera_look_at', ...[eye, target, up].map((v) => numbers(Float64Array, v, 3, 'a place')));
      if (fovDegrees !== undefined) this.#call('rastrum_camera_set_perspective', (fovDegrees * Math.PI) / 180);
    } catch (error) {
      this.free();
      throw error;
    }
  }

  #call(name, ...args) { this.#rastrum._call(name, this.handle, ...args); }

  /** Looks from a side (front, back, left, right, top, bottom, iso), turned; fit() comes next. */
  view(name, azimuthDegrees = 0, elevationDegrees = 0) {
    this.#call('rastrum_wasm_view', name, azimuthDegrees, elevationDegrees);
    return this;
  }

  /** Moves along the view until the scene fills the picture. */
  fit(scene, width, height) {
    this.#call('rastrum_camera_fit', scene.handle, width, height);
    return this;
  }

  zoom(times) {
    this.#call('rastrum_wasm_zoom', times);
    return this;
  }

  free() {
    this.#rastrum._plain('rastrum_camera_free', this.handle);
    this.handle = 0;
  }
}
