// SPDX-License-Identifier: BSD-3-Clause
// Bad files give the reader's message before a target is touched. Scenes that cannot be drawn out
// of core are refused by name. Memory limits are kept or refused.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/large_file.hpp>

#include "tests/out_of_core/large_files.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::bad_large_files_test {
namespace {

struct Said {
  std::string text;
  Errc code{};
};

template <class F>
Said said_by(const F& f) {
  try {
    f();
  } catch (const Error& e) {
    return {e.what(), e.code()};
  }
  return {"nothing", {}};
}

/// Draws the file and checks whether a pixel was touched.
Said drawn(const std::filesystem::path& file, const OutOfCoreOptions& options = {}) {
  Image<Rgba8> image(20, 20);
  std::ranges::fill(image.pixels(), Rgba8{1, 2, 3, 4});
  FrameOptions frame{.width = 20, .height = 20};
  const Said said = said_by(
      [&] { (void)OutOfCoreFile(file).render(Camera{}, frame, {.color8 = image}, options); });
  for (const Rgba8 p : image.pixels()) {
    EXPECT_EQ(p, (Rgba8{1, 2, 3, 4}));
  }
  return said;
}

/// Draws the file. Returns "nothing" or the error.
std::string drawn_at_all(const std::filesystem::path& file) {
  Image<Rgba8> image(20, 20);
  FrameOptions frame{.width = 20, .height = 20};
  return said_by([&] {
           (void)OutOfCoreFile(file).render(Camera{.eye = {0, 0, 3}}, frame, {.color8 = image}, {});
         })
      .text;
}

/// OutOfCoreFile's message for a file. If it leaves the error to the reader, drawn()'s.
Said opened(const std::filesystem::path& file) {
  const Said said = said_by([&] { (void)io::LargeFile::open(file); });
  return said.text == "nothing" ? drawn(file) : said;
}

TEST(BadLargeFiles, SayWhatTheReaderSays) {
  const TempFolder folder;
  const Mesh mesh = tangled();
  const std::string good = ply_of(mesh), stl = stl_of(mesh), npy = npy_of(mesh, false, false);
  const auto npy_with = [&](const std::string& type, const std::string& shape) {
    return io::npy_header_text(type, shape) + npy.substr(128);
  };
  std::string lies = npy;
  lies[8] = static_cast<char>(lies[8] + 24);  // two numbers of the first triangle
  const std::string faces = "element face " + std::to_string(mesh.indices.size() / 3);
  const auto with_index = [&](std::size_t triangle, std::uint32_t index) {
    Mesh bad = mesh;
    bad.indices[3 * triangle + 1] = index;
    return ply_of(bad);
  };
  struct Row {
    std::string name, bytes, words = "";
    Errc code = Errc::bad_format;
  };
  for (const auto& [name, bytes, words, code] : std::initializer_list<Row>{
           {"short.ply", good.substr(0, good.size() - 5)},
           {"shorter.ply", good.substr(0, good.size() / 3)},
           {"header.ply", good.substr(0, 60)},
           {"many.ply", changed(good, faces, "element face 18446744073709551615")},
           {"vertices.ply", changed(good, "element vertex ", "element vertex 99999")},
           {"index.ply", with_index(200, 5000)},
           {"negative.ply", with_index(7, ~std::uint32_t{0})},
           {"empty.ply", ""},
           {"no.ply", "no ply"},
           {"short.stl", stl.substr(0, stl.size() - 60)},
           {"empty.stl", ""},
           {"short.npy", npy.substr(0, npy.size() - 1)},
           {"shorter.npy", npy.substr(0, 128 + 36 * 5 + 7), "ends after 5 of "},
           {"header.npy", npy.substr(0, 100), "inside its header"},
           {"empty.npy", ""},
           {"no.npy", "no array at all"},
           {"many.npy", npy_with("<f4", "(4611686018427387905, 3, 3)"),
            "of 4611686018427387905 triangles"},
           {"beyond.npy", npy_with("<f4", "(18446744073709551616, 3, 3)")},
           {"nine.npy", npy_with("<f4", "(18446744073709551616, 9)"), "no number below"},
           {"negative.npy", npy_with("<f4", "(-1, 3, 3)")},
           {"lies.npy", lies, "its length is wrong"},
           {"big.npy", npy_with(">f4", "(4, 3, 3)"), "", Errc::unsupported},
           {"wide.npy", npy_with(">f8", "(4, 9)"), "not little-endian", Errc::unsupported},
           {"fortran.npy", changed(npy, "False, ", "True,  "), "Fortran order", Errc::unsupported},
           {"object.npy", npy_with("|O", "(4, 3, 3)"), "type '|O'", Errc::unsupported},
           {"objects.npy", npy_with("|O", "(4, 9)"), "type '|O'", Errc::unsupported},
           {"integers.npy", npy_with("<i8", "(4, 3, 3)"), "", Errc::unsupported},
           {"heights.npy", npy_with("<f4", "(12, 12)"), "shape (12, 12) is not that of triangles",
            Errc::unsupported},
           {"flat.npy", npy_with("<f4", "(12,)"), "", Errc::unsupported},
           {"records.npy", changed(npy, "'<f4'", "['x']"), "", Errc::unsupported}}) {
    SCOPED_TRACE(name);
    const auto file = folder.write(name, bytes);
    const Said reader = said_by([&] { (void)io::read_scene(file); });
    const Said large = drawn(file, {.chunk_triangles = 50});
    EXPECT_EQ(large.text, reader.text);
    EXPECT_EQ(large.code, reader.code);
    EXPECT_EQ(large.code, code);
    EXPECT_TRUE(holds(large.text, name));
    EXPECT_TRUE(holds(large.text, words));
  }
  EXPECT_EQ(drawn(folder.path("none.ply")).code, Errc::not_found);
}

TEST(BadLargeFiles, OtherKindsAreRefusedByName) {
  const TempFolder folder;
  const std::string good = ply_of(tangled());
  const auto expect = [&](const std::string& name, const std::string& bytes,
                          const std::string& words) {
    const Said said = opened(folder.write(name, bytes));
    EXPECT_EQ(said.code, Errc::unsupported) << said.text;
    EXPECT_TRUE(holds(said.text, words));
    EXPECT_TRUE(holds(said.text, name));
  };
  expect("a.ply", changed(good, "binary_little_endian", "ascii"), "it is text");
  expect("b.ply", changed(good, "binary_little_endian", "binary_big_endian"), "order");
  expect("c.ply", changed(good, "property float z", "property double z"),
         "not all float32 or all float64");
  std::string quads = good;
  const std::size_t face =
      quads.find("end_header\n") + 11 + 12 * tangled().positions.size() + 13 * 3;
  quads[face] = 4;
  quads.insert(face + 13, raw(std::uint32_t{0}));
  expect("d.ply", quads, "face 3 has 4 corners");
  expect("e.obj", "v 0 0 0\n", ".ply, .stl, .glb, .npy");
  expect("f.stl", "solid text\nendsolid text\n", "text");
}

TEST(BadLargeFiles, GlbOfSeveralMeshesNamesWhatItIsOf) {
  const TempFolder folder;
  const std::vector<Mesh> meshes(4, tangled());
  const std::string good = many_glb_of(meshes, "");
  const auto expect = [&](const std::string& bytes, const std::string& words, Errc code) {
    const Said said = opened(folder.write("a.glb", bytes));
    EXPECT_EQ(said.code, code) << said.text;
    EXPECT_TRUE(holds(said.text, words));
  };
  // The replacements have the same length, so that chunks stay in place.
  expect(changed(good, R"("indices":5})", R"("mode":5   })"),
         "meshes[1].primitives[0]: it is no list of triangles", Errc::unsupported);
  expect(changed(good, R"("children":[3,1]})", R"("children":[3,2]})"), "node 2 is reached twice",
         Errc::bad_format);
  expect(changed(good, R"({"mesh":1,"scale")", R"({"mesh":7,"scale")"), "mesh 7 of 3",
         Errc::bad_format);
  expect(changed(good, R"("mesh":1,"translation":[0,-0.6,0.5])",
                 std::string(R"("mesh":1,"skin":0)").append(18, ' ')),
         "nodes[5]: it moves", Errc::unsupported);
  std::string longer = good;
  longer[11] = 1;  // in the file length of its header
  expect(longer, "its header says", Errc::bad_format);
  std::vector<Mesh> bad = meshes;
  bad[2].indices[30] = 1'000'000;
  expect(many_glb_of(bad, ""), "meshes[1].primitives[1].indices: refers to vertex 1000000 of 474",
         Errc::bad_format);
  expect(many_glb_of(meshes, R"({},{}],"images":[{"bufferView":99})"), "a.glb", Errc::bad_format);
  // Deeper than the stack allows.
  const std::size_t deep = 300'000;
  expect(
      many_glb_of(meshes, R"({},{}],"extras":[)" + std::string(deep, '[') + std::string(deep, ']')),
      "nested too deep", Errc::bad_format);
}

/// Cuts a file within each of its parts and between them.
TEST(BadLargeFiles, CutAnywhereIsAnError) {
  const TempFolder folder;
  const Mesh mesh = tangled();
  const std::pair<std::string, std::string> files[] = {
      {"a.ply", ply_of(mesh)},
      {"b.ply", ply_of(mesh, {.normals = true, .colors = true})},
      {"a.stl", stl_of(mesh)},
      {"a.npy", npy_of(mesh, false, false)},
      {"b.npy", npy_of(mesh, true, true)},
      {"a.glb", glb_of(mesh, true, "{}")},
      {"b.glb", many_glb_of({mesh, tangled(2), tangled(3), tangled(4)}, "{},{}")}};
  for (const auto& [name, bytes] : files) {
    EXPECT_EQ(drawn_at_all(folder.write(name, bytes)), "nothing") << name;
    for (std::size_t i = 0; i < 24; ++i)
      for (const std::size_t length : {i * 40, bytes.size() * i / 24, bytes.size() - 1 - i / 2}) {
        if (length >= bytes.size()) continue;
        const Said said = drawn(folder.write(name, bytes.substr(0, length)));
        EXPECT_TRUE(holds(said.text, name)) << length << ": " << said.text;
        EXPECT_TRUE(said.code == Errc::bad_format || said.code == Errc::unsupported)
            << length << ": " << said.text;
      }
  }
}

/// Numbers of a GLB that are invalid, missing, or overflow when multiplied.
TEST(BadLargeFiles, GlbNumbersThatOverflowAreSaid) {
  const TempFolder folder;
  const std::string good = glb_of(tangled(), false, "{}");
  const std::size_t json = 20, end = json + good.find("BIN") - 4 - json;
  const std::string text = good.substr(json, end - json), bin = good.substr(end);
  int tried = 0;
  for (const char* const key :
       {"\"count\":", "\"byteOffset\":", "\"byteLength\":", "\"byteStride\":", "\"bufferView\":",
        "\"indices\":", "\"POSITION\":", "\"NORMAL\":", "\"mesh\":", "\"nodes\":[",
        "\"scene\":", "\"buffer\":", "\"material\":"})
    for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1))
      for (const char* const number :
           {"-1", "4611686018427387905", "18446744073709551615", "18446744073709551616", "1e300",
            "\"1\"", "null", "2147483648"}) {
        const std::size_t begin = at + std::string_view(key).size();
        std::string changed = text;
        changed.replace(begin, text.find_first_of(",}]", begin) - begin, number);
        changed.resize((changed.size() + 3) / 4 * 4, ' ');
        std::string bytes = good.substr(0, 12) + raw(static_cast<std::uint32_t>(changed.size())) +
                            "JSON" + changed + bin;
        const std::uint32_t all = static_cast<std::uint32_t>(bytes.size());
        std::memcpy(bytes.data() + 8, &all, sizeof(all));
        const Said said = drawn(folder.write("a.glb", bytes));
        EXPECT_TRUE(holds(said.text, "a.glb")) << key << number << ": " << said.text;
        ++tried;
      }
  EXPECT_GT(tried, 150);
}

TEST(BadLargeFiles, OptionsAreRefusedByName) {
  const TempFolder folder;
  const OutOfCoreFile file(folder.write("a.ply", ply_of(tangled())));
  Image<Rgba8> color(16, 16);
  Image<std::uint64_t> keys(16, 16);
  Image<std::uint32_t> overdraw(16, 16);
  FrameOptions frame{.width = 16, .height = 16};
  const auto expect = [&](const FrameOptions& o, const Targets& targets, const char* words,
                          const OutOfCoreOptions& options = {}, Errc code = Errc::unsupported) {
    const Said said = said_by([&] { (void)file.render(Camera{}, o, targets, options); });
    EXPECT_EQ(said.code, code) << said.text;
    EXPECT_TRUE(holds(said.text, words));
  };
  FrameOptions o = frame;
  o.shader = Shader::id;
  expect(o, {.color8 = color}, "'id'");
  o = frame;
  o.lights = light_kit();
  o.shadows = true;
  expect(o, {.color8 = color}, "shadows");
  expect(frame, {.color8 = color, .keys = keys}, "keys");
  expect(frame, {.color8 = color, .overdraw = overdraw}, "overdraw");
  o = frame;
  o.width = 0;
  expect(o, {.color8 = color}, "size", {}, Errc::invalid_argument);
  expect(frame, {.color8 = color}, "memory limit of 1000000 bytes", {.memory_limit = 1000000},
         Errc::out_of_memory);
}

/// A mapped file may become shorter while it is read. This gives zeros and an Error, and the
/// process survives.
TEST(BadLargeFiles, AFileThatBecomesShorterWhileItIsReadIsNoticed) {
  const TempFolder folder;
  Mesh mesh = tangled();
  // Makes a file of many pages.
  for (int i = 0; i < 20'000; ++i) mesh.positions.push_back({0, 0, static_cast<float>(i)});
  const auto last_vertex = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  mesh.indices.insert(mesh.indices.end(), {0, 1, last_vertex});
  for (const bool by_stl : {false, true}) {
    if (by_stl)
      for (int i = 0; i < 6; ++i)
        mesh.indices.insert(mesh.indices.end(), mesh.indices.begin(), mesh.indices.end());
    const auto path =
        by_stl ? folder.write("a.stl", stl_of(mesh)) : folder.write("a.ply", ply_of(mesh));
    const auto expect_shorter = [&](const Said& said) {
      EXPECT_EQ(said.code, Errc::io);
      EXPECT_TRUE(holds(said.text, path.filename().string() + ": has become shorter"));
    };
    {
      const OutOfCoreFile file(path);
      FitOfFile fit(file);
      (void)fit_picture({}, {}, 20, 20, {.ranks = &fit});
      std::filesystem::resize_file(path, 5000);
      expect_shorter(said_by([&] { (void)fit_picture({}, {}, 20, 20, {.ranks = &fit}); }));
    }
    folder.write(path.filename().string(), by_stl ? stl_of(mesh) : ply_of(mesh));
    const auto file = io::LargeFile::open(path);
    std::vector<std::uint64_t> all(file->triangles());
    for (std::size_t t = 0; t < all.size(); ++t) all[t] = t;
    io::FileChunk chunk;
    file->read(0, all.size(), std::size_t{1} << 30, chunk);
    file->drop(chunk);
    std::filesystem::resize_file(path, 5000);
    if (!by_stl) {
      // Like a renderer's thread, after every check.
      float last = 0;
      for (std::size_t v = 0; v < chunk.positions.size(); ++v) last = chunk.positions[v].z;
      EXPECT_EQ(last, 0);
    }
    expect_shorter(said_by([&] { file->check_length(); }));
    expect_shorter(said_by([&] { (void)file->selection(all); }));
    // The file has its old length again, but the reader does not know yet that its data was wrong.
    std::filesystem::resize_file(path, file->bytes());
    if (!by_stl) {
      const Said said = said_by([&] { file->check_length(); });
      EXPECT_TRUE(holds(said.text, "could not be read whole"));
    }
  }
}

TEST(BadLargeFiles, AFileThatBecomesShorterIsNoticed) {
  const TempFolder folder;
  const auto path = folder.write("a.ply", ply_of(tangled()));
  const OutOfCoreFile file(path);
  Image<Rgba8> color(16, 16);
  FrameOptions frame{.width = 16, .height = 16};
  OutOfCoreOptions options{.chunk_triangles = 20};
  int calls = 0;
  options.progress = [&](std::string_view, std::uint64_t, std::uint64_t) {
    if (++calls == 3) std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  };
  const Said said =
      said_by([&] { (void)file.render(Camera{}, frame, {.color8 = color}, options); });
  EXPECT_EQ(said.code, Errc::io) << said.text;
  EXPECT_TRUE(holds(said.text, "has become shorter"));
}

}  // namespace
}  // namespace rastrum::test::bad_large_files_test
