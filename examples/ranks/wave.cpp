// SPDX-License-Identifier: BSD-3-Clause
// In situ on MPI ranks: each has a strip of a surface on which the waves of two sources meet, and
// all draw one picture from their own memory. Any number of ranks writes the same files.
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <mpi.h>

#include <rastrum/io.hpp>
#include <rastrum/mpi/mpi_ranks.hpp>

using Node = std::array<double, 3>;  // x, height, z

double height_at(double x, double z, double time) {
  const auto from = [&](double source) {
    const double distance = std::hypot(x - source, z);
    return distance > time ? 0 : 0.012 * std::sin(80 * (distance - time)) / (0.2 + distance);
  };
  return from(0.35) + from(0.65);
}

void simulate(rastrum::Communicator& ranks) {
  constexpr int kCells = 400, kRow = kCells + 1;  // along each side; nodes of a row
  const int n = ranks.size(), first = kCells * ranks.rank() / n;
  const int last = kCells * (ranks.rank() + 1) / n;
  std::vector<Node> nodes;  // of the rows first to last
  for (int i = first * kRow; i < (last + 1) * kRow; ++i)
    nodes.push_back({i % kRow / double(kCells), 0, i / kRow / double(kCells)});
  std::vector<int> quads;  // four nodes each
  for (int i = 0; i < (last - first) * kRow; ++i)
    if (i % kRow != kCells) quads.insert(quads.end(), {i, i + kRow, i + kRow + 1, i + 1});
  rastrum::MeshView mesh{.positions = nodes, .indices = quads};
  mesh.faces.kind = rastrum::FaceKind::quads;
  mesh.scalars.values = rastrum::ScalarView::of(&nodes[0][1], nodes.size(), sizeof(Node));
  const rastrum::InstanceView strip{mesh};
  const auto part = static_cast<std::uint64_t>(ranks.rank());  // among those of all ranks
  const rastrum::ScalarMapping colors{.map = rastrum::color_map("coolwarm"), .symmetric = true};
  const rastrum::SceneView scene{.instances = {&strip, 1}, .scalar_mappings = {&colors, 1}};
  const rastrum::Camera camera{.eye = {0.9, 0.55, 1.25}, .target = {0.5, -0.05, 0.52}};
  const rastrum::FrameOptions frame{.width = 960, .height = 540, .samples = 4};
  rastrum::Image<rastrum::Rgba8> picture(frame.width, frame.height);
  rastrum::Renderer renderer({.threads = 1});
  for (int step = 1; step <= 3; ++step) {
    for (Node& p : nodes) p[1] = height_at(p[0], p[2], step / 3.0);
    rastrum::render_parts(ranks, renderer, scene, {&part, 1}, camera, frame, {.color8 = picture});
    if (ranks.rank() == 0) rastrum::io::write_png("wave" + std::to_string(step) + ".png", picture);
  }
}

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  {
    rastrum::mpi::MpiRanks ranks(MPI_COMM_WORLD);  // ends before MPI does
    simulate(ranks);
  }
  MPI_Finalize();
}
