// SPDX-License-Identifier: BSD-3-Clause
export type Numbers = Float32Array | Float64Array | Uint8Array | Int8Array | Uint16Array | Int16Array | Uint32Array
  | Int32Array | BigUint64Array | BigInt64Array;

export declare class RastrumError extends Error {
  /** rastrum_status of rastrum.h: 1 invalid argument, 3 io, 4 bad format, 5 unsupported, 6 out of memory, … */
  status: number;
}

export interface Light {
  kind: 'ambient' | 'directional' | 'point';
  /** The way in which a directional light travels, or the place of a point light. */
  vector?: number[];
  color?: number[];
  intensity?: number;
  /** `vector` is in the camera's axes. */
  ofCamera?: boolean;
}

export interface FrameOptions {
  width: number;
  height: number;
  /** Images of docs/outputs.md; 'color8' alone unless it is said. */
  targets?: string[];
  /** Those of `targets` whose digests are made. */
  digests?: string[];
  shader?: 'auto' | 'flat' | 'depth' | 'normal' | 'id' | 'lambert' | 'phong' | 'material' | 'wireframe' | 'classic';
  background?: number[];
  samples?: 1 | 4 | 8 | 16;
  opacity?: number;
  shadows?: boolean;
  cull?: 'none' | 'back' | 'front';
  lights?: Light[] | 'studio';
}

/** The images by their names, row 0 at the top, and the digests that were asked for, which equal those of `rastrum --hash`. */
export interface Picture {
  width: number;
  height: number;
  digests: Record<string, string>;
  color8?: Uint8ClampedArray;
  depth?: Float32Array;
  ids32?: Int32Array;
  [target: string]: any;
}

export interface MeshOptions {
  normals?: Numbers;
  /** Three or four numbers each. */
  colors?: Numbers;
  /** What `normals` and `colors` belong to. */
  per?: 'vertex' | 'corner' | 'face' | 'mesh';
  color?: number[];
  opacity?: number;
  /** 16 numbers, row by row. */
  transform?: number[];
}

export interface Scene {
  readonly warnings: string[];
  readonly primitives: number;
  addMesh(positions: Numbers, indices?: Numbers | null, options?: MeshOptions): number;
  free(): void;
}

export interface Camera {
  view(name: 'front' | 'back' | 'left' | 'right' | 'top' | 'bottom' | 'iso', azimuthDegrees?: number,
    elevationDegrees?: number): this;
  fit(scene: Scene, width: number, height: number): this;
  zoom(times: number): this;
  free(): void;
}

export interface Rastrum {
  readonly version: string;
  /** Bytes of the module's memory, which grows and never shrinks. */
  readonly memoryBytes: number;
  /** Reads a file by its extension; the others are its companions (.mtl, .bin, pictures). */
  read(files: Record<string, Uint8Array> | Map<string, Uint8Array>, name: string, options?: { creaseDegrees?: number }): Scene;
  shape(spec: string): Scene;
  scene(): Scene;
  camera(options?: { eye?: number[]; target?: number[]; up?: number[]; fovDegrees?: number }): Camera;
  render(scene: Scene, camera: Camera, options: FrameOptions): Picture;
}

/** Loads the module; rastrum.wasm beside this file unless another is given. */
export declare function load(source?: string | URL | Response | BufferSource): Promise<Rastrum>;
