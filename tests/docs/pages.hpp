// SPDX-License-Identifier: BSD-3-Clause
// The names that C++ blocks of README.md and docs/*.md use without declaring them, for
// `tools/docs.py compile`. Blocks are only compiled, so nothing is defined.
#pragma once

#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <rastrum/annotate.hpp>
#include <rastrum/family.hpp>
#include <rastrum/io.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/out_of_core.hpp>
#include <rastrum/prepared_mesh.hpp>
#include <rastrum/program.hpp>
#include <rastrum/ranks.hpp>
#include <rastrum/render.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/transform.hpp>

#if __has_include(<mpi.h>)
#include <rastrum/mpi/mpi_ranks.hpp>
extern MPI_Comm comm;
#endif

namespace rt = rastrum::terrain;

// Arrays.
extern std::vector<rastrum::Vec3> positions, centers;
extern std::vector<rastrum::Vec4> colors, viridis;
extern std::vector<std::uint32_t> indices;
extern std::vector<std::int64_t> connectivity, offsets;
extern std::vector<float> flat, radii;
extern std::vector<double> temperature;
extern const double* xyz;
extern const float* xyzrgb;
extern const std::uint8_t* rgb8;
extern std::size_t vertex_count, n, cells;

// Scenes and how they are seen.
extern rastrum::SceneView scene, first, second;
extern rastrum::Mat4d object_to_world;
extern rastrum::Camera camera, along;
extern std::vector<rastrum::Camera> cameras;
extern rastrum::FrameOptions frame;
extern std::vector<rastrum::ProgramDraw> draws;
extern rastrum::Image<float> heights;
extern std::uint64_t triangles_of_first;
extern std::vector<std::uint64_t> parts;

// Renderers and targets.
extern rastrum::Renderer renderer;
extern rastrum::Communicator& ranks;
extern rastrum::Targets targets;
extern rastrum::Image<rastrum::Rgba8> image, picture, color8, photo;
extern rastrum::Image<float> depth, numbers, factor;
extern rastrum::Image<std::int64_t> ids;
extern int width, height;
extern rastrum::Vec4 background;
void draw_smaller();
