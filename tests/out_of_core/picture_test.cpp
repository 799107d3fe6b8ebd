// SPDX-License-Identifier: BSD-3-Clause
// Pictures of unread files equal those of read files, bit for bit: every target, for chunks of one
// triangle to all, opaque and translucent, with one sample and several, with normals from the file,
// of faces and computed, in one band and many.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/family.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/io/large_file.hpp>

#include "tests/io/gltf_document.hpp"
#include "tests/out_of_core/large_files.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::out_of_core_picture_test {
namespace {

Camera inside() {
  return Camera{.eye = {0.1, 0.05, 0.2}, .target = {1, 0.3, -0.5}, .near_plane = 0.01F};
}

void smooth(Scene& scene) {
  for (Mesh& mesh : scene.meshes)
    mesh.normals.values = vertex_normals(mesh.positions, mesh.indices);
}

TEST(OutOfCore, ChunksOfEverySizeGiveTheBitsOfOneMesh) {
  const TempFolder folder;
  const Mesh mesh = tangled();
  const auto ply = folder.write("a.ply", ply_of(mesh));
  for (const std::uint64_t chunk : {1U, 7U, 64U, 100000U})
    for (const float opacity : {1.0F, 0.3F})
      for (const Camera& camera : {outside(), inside()}) {
        if (chunk == 1 && opacity < 1) continue;  // slow, and like 7
        const OutOfCoreStats stats = expect_same(
            ply, camera, frame_of(97, 71, Shader::phong, opacity), {.chunk_triangles = chunk},
            std::to_string(chunk) + " " + std::to_string(opacity));
        EXPECT_EQ(stats.bands, 1U);
        EXPECT_EQ(stats.chunk, std::min<std::uint64_t>(chunk, mesh.triangle_count()));
        EXPECT_LT(stats.seen, stats.triangles);
        EXPECT_GT(stats.seen, 10U);
      }
}

TEST(OutOfCore, NormalsAreThoseOfTheWholeMesh) {
  const TempFolder folder;
  const Mesh mesh = tangled();
  const auto ply = folder.write("a.ply", ply_of(mesh));
  const auto stl = folder.write("a.stl", stl_of(mesh));
  for (const auto& file : {ply, stl})
    for (const float opacity : {1.0F, 0.3F}) {
      const FrameOptions frame = frame_of(80, 60, Shader::phong, opacity);
      OutOfCoreOptions options{.chunk_triangles = 31};
      expect_same(file, outside(), frame, options, file.string() + " faces");
      options.neighbours = true;
      options.prepare = crease;
      expect_same(file, outside(), frame, options, file.string() + " creases");
      options.prepare = smooth;
      expect_same(file, inside(), frame, options, file.string() + " smooth");
    }
  expect_same(folder.write("n.ply", ply_of(mesh, {.normals = true})), outside(), frame_of(80, 60),
              {.chunk_triangles = 40}, "of the file");
}

TEST(OutOfCore, ColoursMakeLayersOfAllOrOfNone) {
  const TempFolder folder;
  const Mesh mesh = tangled(11);
  for (const int alpha : {255, 100, 0})
    for (const Shader shader : {Shader::phong, Shader::flat, Shader::normal, Shader::depth}) {
      const auto file = folder.write(
          "c.ply", ply_of(mesh, {.colors = true, .alpha = static_cast<std::uint8_t>(alpha)}));
      expect_same(file, outside(), frame_of(64, 64, shader), {.chunk_triangles = 50},
                  std::to_string(alpha) + " " + std::string(name(shader)));
    }
  // The translucent vertex is out of sight, but visible surfaces are blended anyway.
  Mesh alone = mesh;
  alone.positions.insert(alone.positions.begin(), {Vec3{0, 0, 50}});
  for (std::uint32_t& i : alone.indices) ++i;
  std::string bytes = ply_of(alone, {.colors = true, .alpha = 255});
  const std::size_t vertex = bytes.find("end_header\n") + 11;
  bytes[vertex + 15] = 10;
  const OutOfCoreStats stats = expect_same(folder.write("d.ply", bytes), outside(),
                                           frame_of(64, 64), {.chunk_triangles = 50}, "unused");
  EXPECT_EQ(stats.frame.visibility, "layers");
}

TEST(OutOfCore, GlbWithItsMaterialAtItsNode) {
  const TempFolder folder;
  const Mesh mesh = tangled(13);
  const char* const materials[] = {
      "", R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.1,1]}})",
      R"({"doubleSided":true,"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.4,0.9,0.4]}})"};
  for (const bool short_indices : {true, false})
    for (const char* material : materials) {
      const auto file = folder.write("a.glb", glb_of(mesh, short_indices, material));
      expect_same(file, outside(), frame_of(60, 50, Shader::automatic), {.chunk_triangles = 45},
                  material);
      const OutOfCoreFile large(file);
      EXPECT_EQ(large.has_materials(), *material != 0);
      const Scene scene = io::read_scene(file);
      FitOfFile fit(large);
      EXPECT_EQ(fit_picture(SceneBinding(scene).view(), outside(), 60, 50).eye,
                fit_picture({}, outside(), 60, 50, {.ranks = &fit}).eye);
    }
}

TEST(OutOfCore, GlbOfSeveralMeshesAtSeveralNodes) {
  const TempFolder folder;
  const std::vector<Mesh> meshes = {tangled(13), tangled(17), shapes::torus_knot(2, 3, 40, 8),
                                    tangled(3)};
  const char* const materials[] = {
      "",
      R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.1,1]}},)"
      R"({"doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[0.2,0.9,0.1,1]}})",
      R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.1,1]}},{"doubleSided":true,)"
      R"("alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.4,0.9,0.4]}})"};
  for (const char* material : materials) {
    const auto file = folder.write("a.glb", many_glb_of(meshes, material));
    const Scene scene = io::read_scene(file);
    ASSERT_EQ(scene.instances.size(), 7U);
    const OutOfCoreFile large(file);
    EXPECT_EQ(large.triangles(), scene.triangle_count());
    FitOfFile fit(large, {}, 2);
    const Camera camera = fit_picture(SceneBinding(scene).view(), outside(), 90, 70);
    EXPECT_EQ(camera.eye, fit_picture({}, outside(), 90, 70, {.ranks = &fit}).eye);
    for (const std::uint64_t chunk : {33U, 100000U})
      for (const bool fitted : {false, true}) {
        const OutOfCoreStats stats =
            expect_same(file, camera, frame_of(90, 70, Shader::automatic),
                        {.chunk_triangles = chunk}, std::string(material) + " all", fitted);
        EXPECT_LT(stats.seen, stats.triangles);
        expect_same(file, inside(), frame_of(90, 70, Shader::automatic), {.chunk_triangles = chunk},
                    std::string(material) + " inside", fitted);
      }
    // Computed normals, several samples, bands.
    OutOfCoreOptions options{.chunk_triangles = 90, .prepare = crease, .neighbours = true};
    expect_same(file, camera, frame_of(60, 80, Shader::phong), options, "creases");
    FrameOptions frame = frame_of(60, 80, Shader::phong, 0.5F);
    frame.samples = 4;
    options.prepare = {};
    options.neighbours = false;
    options.band_triangles = expect_same(file, camera, frame, options, "samples").seen * 2 / 3;
    EXPECT_GT(expect_same(file, camera, frame, options, "samples in bands").bands, 1U);
  }
}

TEST(OutOfCore, GlbWhoseWholeNumbersHaveAPoint) {
  const TempFolder folder;
  const char* const materials =
      R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.1,1]}},{"doubleSided":true})";
  for (const std::string& glb :
       {glb_of(tangled(13), true, materials),
        many_glb_of({tangled(13), tangled(17), tangled(2), tangled(3)}, materials)}) {
    const std::string text = with_points(json_of(glb));
    ASSERT_TRUE(holds(text, ".0,"));
    const auto file = folder.write("a.glb", glb_with(glb, text));
    expect_same(file, outside(), frame_of(60, 50, Shader::automatic), {.chunk_triangles = 45},
                "points");
    EXPECT_EQ(OutOfCoreFile(file).triangles(),
              OutOfCoreFile(folder.write("b.glb", glb)).triangles());
  }
}

/// Nodes count against the limit too: each takes JSON and an instance.
TEST(OutOfCore, MemoryOfNodesCounts) {
  const TempFolder folder;
  const auto write = [&](const char* name, int count) {
    std::vector<std::string> nodes;
    for (int i = 0; i < count; ++i)
      nodes.push_back(R"({"mesh":0,"translation":[)" + std::to_string(i) + ",0,-3]}");
    return folder.write(name, glb_of(tangled(13), true, "", nodes));
  };
  const OutOfCoreOptions options{.memory_limit = std::uint64_t{60} << 20};
  EXPECT_GT(expect_same(write("a.glb", 50), outside(), frame_of(30, 20), options, "few").seen, 0U);
  Image<Rgba8> image(30, 20);
  expect_refused("a memory limit of 62914560 bytes is too little", Errc::out_of_memory, [&] {
    (void)OutOfCoreFile(write("b.glb", 10'000))
        .render(outside(), frame_of(30, 20), {.color8 = image}, options);
  });
}

/// Nodes without a mesh are not parts, but take memory too.
TEST(OutOfCore, MemoryOfJsonCounts) {
  const TempFolder folder;
  std::vector<std::string> nodes(60'000, "{}");
  nodes.back() = R"({"mesh":0,"translation":[0,0,-1]})";
  const auto file = folder.write("a.glb", glb_of(tangled(13), true, "", nodes));
  Image<Rgba8> image(30, 20);
  const auto draw = [&](std::uint64_t mebibytes) {
    return OutOfCoreFile(file).render(outside(), frame_of(30, 20), {.color8 = image},
                                      {.memory_limit = mebibytes << 20});
  };
  EXPECT_GT(draw(256).seen, 0U);
  expect_refused("a memory limit of 62914560 bytes is too little", Errc::out_of_memory,
                 [&] { (void)draw(60); });
  // Refused before the text becomes a document.
  expect_refused("its JSON alone takes about", Errc::out_of_memory,
                 [&] { (void)OutOfCoreFile(file, std::uint64_t{10} << 20); });
  // Refused before nodes become a scene.
  expect_refused("its nodes and JSON take about", Errc::out_of_memory,
                 [&] { (void)OutOfCoreFile(file, std::uint64_t{24} << 20); });
}

TEST(OutOfCore, PrimitivesOfSeveralMeshesWithoutIds) {
  const TempFolder folder;
  const auto file =
      folder.write("a.glb", many_glb_of({tangled(13), tangled(17), tangled(2), tangled(3)}, ""));
  const FrameOptions frame = frame_of(64, 48, Shader::flat);
  Image<std::int64_t> in_memory(64, 48), out_of_core(64, 48);
  const Scene scene = io::read_scene(file);
  Renderer renderer;
  renderer.render(SceneBinding(scene).view(), outside(), frame, {.primitives = in_memory});
  (void)OutOfCoreFile(file).render(outside(), frame, {.primitives = out_of_core},
                                   {.chunk_triangles = 50});
  EXPECT_TRUE(std::ranges::equal(in_memory.pixels(), out_of_core.pixels()));
}

TEST(OutOfCore, NpyOfTriangles) {
  const TempFolder folder;
  const Mesh mesh = tangled(19);
  for (const bool wide : {false, true})
    for (const bool nine : {false, true}) {
      const auto file = folder.write("a.npy", npy_of(mesh, wide, nine));
      const std::string what = std::string(wide ? "f8" : "f4") + (nine ? " nine" : "");
      for (const std::uint64_t chunk : {1U, 37U, 100000U})
        expect_same(file, outside(), frame_of(60, 50), {.chunk_triangles = chunk}, what);
      FrameOptions frame = frame_of(60, 50, Shader::phong, 0.4F);
      frame.samples = 4;
      OutOfCoreOptions options{.chunk_triangles = 45, .prepare = crease, .neighbours = true};
      expect_same(file, inside(), frame, options, what + " creases", true);
    }
  // The same triangles give the same picture from any file format.
  const Scene npy = io::read_scene(folder.write("b.npy", npy_of(mesh, false, false)));
  const Scene stl = io::read_scene(folder.write("b.stl", stl_of(mesh)));
  EXPECT_EQ(npy.meshes[0].positions, stl.meshes[0].positions);
  EXPECT_EQ(npy.meshes[0].indices, stl.meshes[0].indices);
}

TEST(OutOfCore, AFileOfNoTrianglesIsAPictureOfTheBackground) {
  const TempFolder folder;
  for (const auto& file :
       {folder.write("a.npy", npy_of(Mesh{}, false, false)), folder.write("a.stl", stl_of(Mesh{}))})
    EXPECT_EQ(expect_same(file, outside(), frame_of(40, 30), {}, file.string()).seen, 0U);
}

TEST(OutOfCore, EverySampleHasItsSurface) {
  const TempFolder folder;
  const auto file = folder.write("a.ply", ply_of(tangled()));
  for (const int samples : {4, 8})
    for (const float opacity : {1.0F, 0.3F}) {
      FrameOptions frame = frame_of(60, 44, Shader::phong, opacity);
      frame.samples = samples;
      expect_same(file, outside(), frame, {.chunk_triangles = 60}, std::to_string(samples));
    }
}

TEST(OutOfCore, MethodsPlanesMaterialsAndLights) {
  const TempFolder folder;
  const auto file = folder.write("a.ply", ply_of(tangled()));
  FrameOptions frame = frame_of(60, 44, Shader::phong, 0.4F);
  for (const TransparencyOptions& method :
       {TransparencyOptions{.method = Transparency::none}, family::filtered(3),
        TransparencyOptions{.method = Transparency::unsorted}}) {
    frame.transparency = method;
    expect_same(file, outside(), frame, {.chunk_triangles = 60},
                std::to_string(static_cast<int>(method.method)));
  }
  frame.transparency = {};
  frame.clip_planes = {{{0, 0, -1}, 0.2}};
  expect_same(file, outside(), frame, {.chunk_triangles = 60}, "planes");
  frame.clip_planes.clear();
  for (const Cull cull : {Cull::back, Cull::front}) {
    frame.cull = cull;
    frame.opacity = cull == Cull::back ? 1 : 0.5F;
    expect_same(file, outside(), frame, {.chunk_triangles = 60}, "cull");
  }
  frame.cull = Cull::none;
  const auto paint = [](Scene& scene) {
    add_plain_materials(scene);
    scene.materials[0].base_color = {0.3F, 0.5F, 0.1F, 1};
    scene.materials[0].double_sided = false;
    Mat4d turned = Mat4d::identity();
    turned.m[0][3] = 0.3;
    scene.place(turned);
  };
  for (const float opacity : {1.0F, 0.5F}) {
    frame.shader = Shader::automatic;
    frame.opacity = opacity;
    frame.lights = light_kit();
    expect_same(file, outside(), frame, {.chunk_triangles = 60, .prepare = paint}, "materials");
  }
}

TEST(OutOfCore, FacesOfFewerThanThreeCornersMakeNoTriangle) {
  const TempFolder folder;
  const Mesh mesh = tangled();
  for (const int small : {1, 2, 4})
    for (const std::uint64_t chunk : {1U, 7U, 100000U}) {
      const auto file = folder.write("a.ply", ply_of(mesh, {.small_faces = small}));
      const OutOfCoreStats stats =
          expect_same(file, outside(), frame_of(97, 71), {.chunk_triangles = chunk},
                      std::to_string(small), true);
      EXPECT_EQ(stats.triangles, mesh.triangle_count());
      expect_same(file, inside(), frame_of(97, 71, Shader::phong, 0.3F),
                  {.chunk_triangles = chunk, .prepare = smooth, .neighbours = true}, "smooth");
    }
}

TEST(OutOfCore, AFitSeesWhatTheReaderSees) {
  const TempFolder folder;
  Mesh mesh = tangled();
  mesh.positions.push_back({90, 0, 0});  // belongs to no triangle
  mesh.positions[3].x = std::numeric_limits<float>::quiet_NaN();
  for (const auto& file :
       {folder.write("a.ply", ply_of(mesh)), folder.write("a.stl", stl_of(mesh))}) {
    const Scene scene = io::read_scene(file);
    const SceneBinding binding(scene);
    const OutOfCoreFile large(file);
    FitOfFile fit(large);
    Camera along{.eye = {0, 0, 0}, .target = {-1, -2, -2}};
    const Camera a = fit_picture(binding.view(), along, 300, 200);
    expect_same(a, fit_picture({}, along, 300, 200, {.ranks = &fit}));
    expect_same(fit_camera(binding.view(), 1, false, {0, 0, -1}),
                fit_camera({}, 1, false, {0, 0, -1}, {0, 1, 0}, &fit));
    expect_same(file, a, frame_of(50, 40), {.chunk_triangles = 30}, "NaN");
  }
}

TEST(OutOfCore, VerticesThatLieFarApartAreCopied) {
  const TempFolder folder;
  const Mesh mesh = shuffled_ball();
  for (const std::optional<Vec3d> at :
       {std::optional<Vec3d>{}, {Vec3d{}}, {Vec3d{5.2e6, 0, 5.2e6}}}) {
    const auto path = folder.write("a.ply", ply_of(mesh, {.comment = "x", .wide_at = at}));
    const auto file = io::LargeFile::open(path);
    const Scene scene = io::read_scene(path);
    const ArrayView<Vec3> positions = scene.meshes[0].view().positions;
    const bool rounded = at && !positions.is_wide();
    for (const std::size_t most : {std::size_t{0}, std::size_t{1} << 30}) {
      io::FileChunk chunk;
      for (std::uint64_t first = 0; first < file->triangles(); first += 97) {
        const auto n =
            static_cast<std::size_t>(std::min<std::uint64_t>(97, file->triangles() - first));
        file->read(first, n, most, chunk);
        EXPECT_EQ(chunk.mapped_bytes == 0, most == 0 || rounded);
        EXPECT_EQ(chunk.positions.is_wide(), positions.is_wide());
        for (std::size_t c = 0; c < 3 * n; ++c)
          ASSERT_EQ(chunk.positions.wide(chunk.indices[c]),
                    positions.wide(mesh.indices[3 * static_cast<std::size_t>(first) + c]));
      }
    }
  }
}

/// Small triangles in a row along x, many of them outside of the picture.
Mesh row_of(int count) {
  Mesh mesh;
  Random random(5);
  for (int i = 0; i < count; ++i) {
    const double x = 12.0 * i / count - 6;
    for (int c = 0; c < 3; ++c) {
      const double px = x + random.real(-0.2, 0.2);
      const double py = random.real(-1, 1);
      const double pz = random.real(-0.5, 0.5);
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(
          {static_cast<float>(px), static_cast<float>(py), static_cast<float>(pz)});
    }
  }
  return mesh;
}

TEST(OutOfCore, ChunksOutsideOfThePictureAreNotRead) {
  const TempFolder folder;
  // The first look makes boxes of 16,384 consecutive triangles.
  Mesh mesh = row_of(70'000);
  const FrameOptions frame = frame_of(60, 50, Shader::flat);
  for (const auto& file : {folder.write("a.ply", ply_of(mesh)), folder.write("a.stl", stl_of(mesh)),
                           folder.write("a.npy", npy_of(mesh, false, true))}) {
    const OutOfCoreStats blind =
        expect_same(file, outside(), frame, {.chunk_triangles = 8000}, "no look at all before");
    EXPECT_EQ(blind.skipped, 0U);
    const OutOfCoreStats stats =
        expect_same(file, outside(), frame, {.chunk_triangles = 8000}, "after a fit", true);
    EXPECT_EQ(stats.chunks + stats.skipped, 9U);
    EXPECT_GT(stats.skipped, 2U);
    expect_same(file, inside(), frame, {.chunk_triangles = 8000}, "from inside", true);
  }
  // Dropped triangles are counted wherever they are.
  mesh.positions[5].y = std::numeric_limits<float>::infinity();
  const OutOfCoreStats stats = expect_same(folder.write("b.ply", ply_of(mesh)), outside(), frame,
                                           {.chunk_triangles = 8000}, "not finite", true);
  EXPECT_EQ(stats.dropped, 1U);
}

/// Wavy sheets of 2 n² triangles each, the farthest first; then the nearest once more in the same
/// place.
Mesh sheets(int n, int count) {
  Mesh mesh;
  for (int s = 0; s <= count; ++s) {
    const float z = -0.3F * static_cast<float>(count - 1 - std::min(s, count - 1));
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const float x = 2 * static_cast<float>(i) / static_cast<float>(n) - 1;
        const float y = 2 * static_cast<float>(j) / static_cast<float>(n) - 1;
        mesh.positions.push_back({x, y, z + 0.1F * x * y});
      }
    const auto down = static_cast<std::uint32_t>(n + 1);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const std::uint32_t at = base + static_cast<std::uint32_t>(j * (n + 1) + i);
        mesh.indices.insert(mesh.indices.end(),
                            {at, at + 1, at + down, at + 1, at + down + 1, at + down});
      }
  }
  return mesh;
}

TEST(OutOfCore, ChunksBehindWhatIsThereAreNotRead) {
  const TempFolder folder;
  const Mesh mesh = sheets(182, 4);  // 66,248 triangles each
  Camera close = outside();
  close.eye = {0.1, 0.2, 0.5};
  close.target = {0.05, 0.1, 0};
  close.near_plane = 0.05F;
  for (const auto& file : {folder.write("a.ply", ply_of(mesh)), folder.write("a.stl", stl_of(mesh)),
                           folder.write("a.npy", npy_of(mesh, true, false))}) {
    const OutOfCoreOptions options{.chunk_triangles = 16384};
    const auto skipped = [&](float opacity) {
      const FrameOptions frame = frame_of(120, 90, Shader::phong, opacity);
      const std::string what = file.string() + " " + std::to_string(opacity);
      const OutOfCoreStats stats = expect_same(file, close, frame, options, what, true);
      EXPECT_EQ(stats.chunks + stats.skipped, 21U);
      expect_same(file, outside(), frame, options, what + " from afar", true);
      return stats.skipped;
    };
    // Translucent chunks are skipped only outside of the picture. Three opaque sheets are behind
    // the nearest, each with at least two visible chunks. Some chunks begin before those in front
    // are drawn.
    EXPECT_GE(skipped(1), skipped(0.5F) + 4);
  }
  // Slivers may reach beyond their corners, so long edges prevent skipping.
  Mesh slivers = mesh;
  for (std::size_t t = 0; t < slivers.indices.size(); t += 3 * 16000)
    slivers.indices[t + 2] = slivers.indices[t] + 10;
  expect_same(folder.write("s.ply", ply_of(slivers)), close, frame_of(120, 90),
              {.chunk_triangles = 16384}, "slivers", true);
}

TEST(OutOfCore, HiddenChunksOfRandomMeshesChangeNoBit) {
  const TempFolder folder;
  Random random(31);
  std::uint64_t skipped = 0;
  for (int round = 0; round < 6; ++round) {
    // Bent pieces of a sheet, anywhere in front of the eye, in any order.
    const Mesh piece = sheets(91, 1);
    Mesh mesh;
    for (int k = 0; k < 6; ++k) {
      const double z = random.real(-2, 0.5);
      const double turn = random.real(-0.4, 0.4);
      const double size = random.real(0.4, 1.5);
      const auto base = static_cast<std::uint32_t>(mesh.positions.size());
      for (const Vec3& p : piece.positions)
        mesh.positions.push_back({static_cast<float>(size) * p.x, static_cast<float>(size) * p.y,
                                  static_cast<float>(z + turn * double{p.x}) + 0.2F * p.z});
      for (const std::uint32_t i : piece.indices) mesh.indices.push_back(base + i);
    }
    Camera camera = outside();
    camera.eye = {random.real(-0.3, 0.3), random.real(-0.3, 0.3), 1.6};
    camera.orthographic = round % 3 == 2;
    camera.orthographic_height = 1;
    if (camera.orthographic) camera.far_plane = 10;
    skipped += expect_same(folder.write("a.ply", ply_of(mesh)), camera,
                           frame_of(90, 70, round % 2 == 0 ? Shader::phong : Shader::depth),
                           {.chunk_triangles = 16384}, std::to_string(round), true)
                   .skipped;
  }
  EXPECT_GT(skipped, 6U);
}

TEST(OutOfCore, LaterPassesReadTheChunksOfTheirRows) {
  const TempFolder folder;
  Mesh mesh = row_of(4000);
  for (Vec3& p : mesh.positions) p = {p.y / 3, p.x / 6, p.z};
  const auto file = folder.write("a.ply", ply_of(mesh));
  for (const int samples : {1, 4}) {
    FrameOptions frame = frame_of(40, 120, Shader::phong, 0.4F);
    frame.samples = samples;
    OutOfCoreOptions options{.chunk_triangles = 100, .band_triangles = 1600, .prepare = smooth};
    options.neighbours = true;
    const OutOfCoreStats stats = expect_same(file, outside(), frame, options, "rows");
    EXPECT_GT(stats.bands, 3U);
    // After a first look at everything, each band reads its own chunks and those with neighbours in
    // it.
    EXPECT_LT(stats.chunks, stats.skipped);
  }
}

TEST(OutOfCore, NothingInSightIsAPictureOfTheBackground) {
  const TempFolder folder;
  const auto file = folder.write("a.ply", ply_of(tangled()));
  Camera away = outside();
  away.target = {0.4, 0.7, 9};
  const OutOfCoreStats stats =
      expect_same(file, away, frame_of(40, 30), {.chunk_triangles = 50}, "away");
  EXPECT_EQ(stats.seen, 0U);
}

}  // namespace
}  // namespace rastrum::test::out_of_core_picture_test
