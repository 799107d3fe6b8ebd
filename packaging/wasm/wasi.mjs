// SPDX-License-Identifier: BSD-3-Clause
// The part of WASI that readers need: files in memory, a clock, random numbers, words to the console.

const OK = 0, BAD_FILE = 8, INVALID = 28, IS_FOLDER = 31, NO_ENTRY = 44, NO_SUCH_CALL = 52;
const DEVICE = 2, FOLDER = 3, FILE = 4;
const ROOT = 3; // the one folder that is open from the start: "/"

/** A path without '.', '..' and empty parts. */
export function plain(path) {
  const parts = [];
  for (const part of path.split('/')) {
    if (part === '..') parts.pop();
    else if (part !== '' && part !== '.') parts.push(part);
  }
  return parts.join('/');
}

/** Imports of the module, whose files lie in `files`, a Map from names to Uint8Arrays. */
export class Wasi {
  /** @type {WebAssembly.Memory} */ memory;
  /** @type {Map<string, Uint8Array>} */ files = new Map();
  #open = new Map(); // descriptor → { bytes, at }

  get imports() {
    // WebAssembly passes addresses as numbers with a sign. Calls that are not here are refused as a system without them does.
    const unsigned = (call) => (...values) => call(...values.map((v) => (typeof v === 'number' ? v >>> 0 : v)));
    return new Proxy(this.#calls(), { get: (all, name) => unsigned(all[name] ?? (() => NO_SUCH_CALL)) });
  }

  #view() { return new DataView(this.memory.buffer); }
  #bytes(at, size) { return new Uint8Array(this.memory.buffer, at, size); }

  /** A file by its path. One that was chosen alone is found without its folder, and one whose letters differ in case is found, too. */
  #find(at, size) {
    const name = plain(new TextDecoder().decode(this.#bytes(at, size)));
    if (name === '') return FOLDER;
    if (this.files.has(name)) return this.files.get(name);
    const names = [...this.files.keys()];
    if (names.some((known) => known.startsWith(`${name}/`))) return FOLDER;
    const last = name.split('/').at(-1);
    const alike = (wanted) => names.find((known) => known.toLowerCase() === wanted.toLowerCase());
    return this.files.get(names.find((known) => known === last) ?? alike(name) ?? alike(last));
  }

  #stat(at, found) {
    const view = this.#view();
    this.#bytes(at, 64).fill(0);
    view.setUint8(at + 16, found === FOLDER ? FOLDER : FILE);
    view.setBigUint64(at + 24, 1n, true);
    view.setBigUint64(at + 32, BigInt(found === FOLDER ? 0 : found.length), true);
    return OK;
  }

  /** Reads into `count` vectors from `from` on; stores the number of bytes at `out`. */
  #read(bytes, from, vectors, count, out) {
    const view = this.#view();
    let done = 0;
    for (let i = 0; i < count; ++i) {
      const to = view.getUint32(vectors + 8 * i, true), size = view.getUint32(vectors + 8 * i + 4, true);
      const part = bytes.subarray(from + done, from + done + size);
      this.#bytes(to, part.length).set(part);
      done += part.length;
    }
    view.setUint32(out, done, true);
    return done;
  }

  #calls() {
    return {
      environ_sizes_get: (count, size) => {
        this.#view().setUint32(count, 0, true);
        this.#view().setUint32(size, 0, true);
        return OK;
      },
      environ_get: () => OK,
      clock_time_get: (_id, _precision, out) => {
        this.#view().setBigUint64(out, BigInt(Math.round(performance.now() * 1e6)), true);
        return OK;
      },
      random_get: (at, size) => {
        for (let i = 0; i < size; i += 65536) crypto.getRandomValues(this.#bytes(at + i, Math.min(65536, size - i)));
        return OK;
      },
      sched_yield: () => OK,
      proc_exit: (status) => { throw new Error(`Rastrum has ended itself (${status}), which is a defect`); },
      fd_prestat_get: (fd, out) => {
        if (fd !== ROOT) return BAD_FILE;
        this.#view().setUint32(out, 0, true);
        this.#view().setUint32(out + 4, 1, true);
        return OK;
      },
      fd_prestat_dir_name: (_fd, out) => {
        this.#bytes(out, 1)[0] = '/'.charCodeAt(0);
        return OK;
      },
      fd_fdstat_get: (fd, out) => {
        if (fd > ROOT && !this.#open.has(fd)) return BAD_FILE;
        this.#bytes(out, 24).fill(0);
        this.#view().setUint8(out, fd < ROOT ? DEVICE : fd === ROOT ? FOLDER : FILE);
        this.#bytes(out + 8, 16).fill(255); // all rights
        return OK;
      },
      fd_fdstat_set_flags: () => OK,
      fd_filestat_get: (fd, out) =>
        fd === ROOT ? this.#stat(out, FOLDER) : this.#open.has(fd) ? this.#stat(out, this.#open.get(fd).bytes) : BAD_FILE,
      path_filestat_get: (_folder, _flags, path, size, out) => {
        const found = this.#find(path, size);
        return found === undefined ? NO_ENTRY : this.#stat(out, found);
      },
      path_readlink: (_folder, path, size) => (this.#find(path, size) === undefined ? NO_ENTRY : INVALID),
      path_open: (_folder, _lookup, path, size, _flags, _rights, _inherited, _more, out) => {
        const bytes = this.#find(path, size);
        if (bytes === undefined) return NO_ENTRY;
        if (bytes === FOLDER) return IS_FOLDER;
        let fd = ROOT + 1;
        while (this.#open.has(fd)) ++fd;
        this.#open.set(fd, { bytes, at: 0 });
        this.#view().setUint32(out, fd, true);
        return OK;
      },
      fd_close: (fd) => (this.#open.delete(fd) ? OK : BAD_FILE),
      fd_read: (fd, vectors, count, out) => {
        const file = this.#open.get(fd);
        if (file === undefined) return BAD_FILE;
        file.at += this.#read(file.bytes, file.at, vectors, count, out);
        return OK;
      },
      fd_pread: (fd, vectors, count, from, out) => {
        const file = this.#open.get(fd);
        if (file === undefined) return BAD_FILE;
        this.#read(file.bytes, Number(from), vectors, count, out);
        return OK;
      },
      fd_seek: (fd, by, from, out) => {
        const file = this.#open.get(fd);
        if (file === undefined) return BAD_FILE;
        const to = Number(by) + (from === 0 ? 0 : from === 1 ? file.at : file.bytes.length);
        if (to < 0) return INVALID;
        file.at = to;
        this.#view().setBigUint64(out, BigInt(to), true);
        return OK;
      },
      fd_write: (fd, vectors, count, out) => {
        if (fd !== 1 && fd !== 2) return BAD_FILE;
        const view = this.#view();
        let words = '', done = 0;
        for (let i = 0; i < count; ++i) {
          const size = view.getUint32(vectors + 8 * i + 4, true);
          words += new TextDecoder().decode(this.#bytes(view.getUint32(vectors + 8 * i, true), size));
          done += size;
        }
        view.setUint32(out, done, true);
        console.warn(words);
        return OK;
      },
    };
  }
}
