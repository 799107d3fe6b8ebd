// SPDX-License-Identifier: BSD-3-Clause
// Each option of `rastrum render` once: the picture equals the library's with the same choice.
#include <algorithm>

#include <cmath>
#include <limits>

#include <rastrum/fit.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/parallel/cuda/status.hpp>
#include <rastrum/shapes.hpp>

#include "program.hpp"
#include "tests/support/isa.hpp"

#include "tests/support/painter.hpp"

namespace rastrum::test::options_test {
namespace {

constexpr int kWidth = 72, kHeight = 56;

class Options : public Program {
 protected:
  /// Compares the picture of the boxes with `extra` options with the library's, and also the
  /// depths, since only they show the camera's planes.
  void expect(const Args& extra, const Camera& camera) const {
    const Drawn expected = draw(boxes(), camera, render_);
    must("render --look plain builtin:boxes?count=2 -o p.png --depth d.npy --size 72x56" + extra);
    EXPECT_TRUE(same_pixels(png("p.png"), expected.color8)) << extra;
    EXPECT_TRUE(npy("d.npy").holds(expected.depth)) << extra;
  }
  static Scene boxes() { return scene_of(shapes::boxes(2)); }

  RenderOptions render_{{.width = kWidth, .height = kHeight}};
};

TEST_F(Options, PlainIsTheFitCameraAndPhong) {
  expect({}, fit(boxes(), render_));
  expect(
      "--fit tight --shader phong --device threads --rasterizer auto --cull none --background "
      "#00000000 --normals file",
      fit(boxes(), render_));
}

TEST_F(Options, DefaultSize) {
  const Image<Rgba8> picture = drawn("render --look plain builtin:boxes?count=1");
  EXPECT_EQ(picture.width(), 1280);
  EXPECT_EQ(picture.height(), 720);
}

TEST_F(Options, CameraOfOnesOwn) {
  Camera camera{.eye = {-3, 2.5F, 4},
                .target = {0.25F, 0.5F, -0.125F},
                .up = {0.5F, 1, 0},
                .fov_rad = static_cast<float>(35 * std::acos(-1.0) / 180),
                .near_plane = 0.75F,
                .far_plane = 40};
  Args given("--eye -3,2.5,4 --target 0.25,0.5,-0.125 --up 0.5,1,0 --fov 35 --near 0.75 --far 40");
  expect(given, camera);

  camera.far_plane = std::numeric_limits<float>::infinity();
  given[11] = "inf";
  expect(given, camera);

  camera.orthographic = true;
  camera.orthographic_height = 3.5F;
  camera.far_plane = 40;
  camera.near_plane = -1;
  given[11] = "40";
  given[9] = "-1";
  expect(given + "--orthographic 3.5", camera);
}

TEST_F(Options, OrthographicFit) {
  const Scene scene = boxes();
  Camera view{.orthographic = true};
  const Camera tight = fit_picture(SceneBinding(scene).view(), view, kWidth, kHeight);
  expect("--orthographic fit", tight);
  expect("--orthographic fit --fit", tight);
}

TEST_F(Options, FitDoesNotSwallowAnInputInSilence) {
  refused("render --look plain --fit builtin:boxes -o p.png",
          "--fit: expected tight or sphere, got 'builtin:boxes'; an INPUT stands before");
}

TEST_F(Options, FitOfTheSphereIsWhatItWas) {
  const Scene scene = boxes();
  const SceneBinding binding(scene);
  expect("--fit sphere", fit_camera(binding.view(), 1.04719755F, false));
  expect("--fit sphere --orthographic fit", fit_camera(binding.view(), 1.04719755F, true));
}

TEST_F(Options, ViewsByNameAndAngle) {
  const Scene scene = boxes();
  const SceneBinding binding(scene);
  const auto along = [](const View& v) {
    return Camera{.eye = {0, 0, 0}, .target = v.direction, .up = v.up};
  };
  const auto tight = [&](const View& v) {
    return fit_picture(binding.view(), along(v), kWidth, kHeight);
  };
  for (std::size_t i = 0; i < view_names().size(); ++i)
    expect({"--view", std::string(view_names()[i])}, tight(view_of(static_cast<ViewName>(i))));
  const Vec3d z{0, 0, 1};
  const View front = view_of(ViewName::front), cad = view_of(ViewName::iso, z);
  expect("--azimuth 30 --elevation -20", tight(turned(front, {30, -20, 0})));
  expect("--view iso --up z --roll 15", tight(turned(cad, {0, 0, 15}, z)));
  expect("--zoom 2", zoomed(fit(boxes(), render_), 2));
  const View left = view_of(ViewName::left);
  expect("--fit sphere --view left",
         fit_camera(binding.view(), 1.04719755F, false, left.direction, left.up));
  for (const auto& [options, says] :
       {std::pair{"--view above", "expected front, back, left, right, top, bottom, iso"},
        {"--elevation 91", "looks straight down or up"},
        {"--zoom 0", "must be greater than 0, got '0'"},
        {"--fov 180", "must lie between 0 and 180 degrees, got '180'"},
        {"--orthographic 0", "the height must be greater than 0, got '0'"},
        {"--view top --eye 1,2,3", "--view: turns the camera of --fit"}})
    refused(Args("render --look plain builtin:boxes -o q.png") + options, says);
}

TEST_F(Options, Shaders) {
  for (const std::string_view shader : shader_names()) {
    render_.shader = shader_from_name(shader);
    expect({"--shader", std::string(shader)}, fit(boxes(), render_));
  }
}

TEST_F(Options, Background) {
  render_.background = {0, 0.2F, 1, 128 / 255.0F};
  expect("--background #0033ff80", fit(boxes(), render_));
  EXPECT_EQ(png("p.png")(0, 0), (Rgba8{0, 51, 255, 128}));
}

TEST_F(Options, Cull) {
  std::vector<std::uint64_t> drawn;
  for (const std::string cull : {"none", "back", "front"}) {
    must(
        "render --look plain builtin:boxes?count=1 --size 64x64 --eye 3,2,5 --stats s.json "
        "--cull " +
        cull + " -o " + cull + ".png");
    drawn.push_back(json("s.json")["triangles"]["drawn"].get<std::uint64_t>());
  }
  // Three faces of a box face the eye.
  EXPECT_EQ(drawn, (std::vector<std::uint64_t>{12, 6, 6}));
  EXPECT_TRUE(same_pixels(png("none.png"), png("back.png")));
  EXPECT_FALSE(same_pixels(png("none.png"), png("front.png")));
}

TEST_F(Options, Normals) {
  // A coarse sphere whose normals from the file, by vertex and by face all differ.
  Mesh mesh = shapes::sphere(5, 7);
  must("make sphere?rings=5,segments=7 -o s.ply");
  const auto check = [&](const std::string& choice) {
    Image<Rgba8> picture = drawn("render --look plain s.ply --size 72x56 --normals " + choice);
    const Scene scene = scene_of(mesh);
    EXPECT_TRUE(same_pixels(picture, draw(scene, fit(scene, render_), render_).color8)) << choice;
    return picture;
  };
  const Image<Rgba8> file = check("file");
  mesh.normals.values = vertex_normals(mesh.positions, mesh.indices);
  const Image<Rgba8> vertex = check("vertex");
  mesh.normals = {};
  const Image<Rgba8> face = check("face");
  EXPECT_FALSE(same_pixels(file, face));
  EXPECT_FALSE(same_pixels(vertex, face));
  EXPECT_FALSE(same_pixels(file, vertex));
  // --crease replaces the file's normals.
  mesh.normals = crease_normals(mesh.positions, mesh.indices, 50);
  check("crease --crease 50");
}

TEST_F(Options, NormalsWhereTheFileHasNone) {
  // A quad bent by 60° along its diagonal: sharp by default.
  write("t.obj", "v 0 0 0\nv 1 0 0.5\nv 0 1 0.5\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  const auto drawn = [&](const Args& options) {
    return Program::drawn("render --look plain t.obj --size 40x40" + options);
  };
  const Image<Rgba8> vertex = drawn("--normals vertex"), face = drawn("--normals face");
  EXPECT_FALSE(same_pixels(face, vertex));
  for (const char* sharp : {"", "--normals file", "--normals crease --crease 10"})
    EXPECT_TRUE(same_pixels(drawn(sharp), face)) << sharp;
  for (const char* smooth : {"--crease 180", "--normals crease --crease 120"})
    EXPECT_TRUE(same_pixels(drawn(smooth), vertex)) << smooth;
}

TEST_F(Options, MachineChoicesReachTheStatisticsAndLeaveThePictureAlone) {
  const std::string boxes = "render --look plain builtin:boxes?count=2 --size 72x56 ";
  std::string ids;
  const auto stats = [&](const std::string& extra) {
    must(boxes + "--stats s.json --ids i.npy " + extra);
    const std::string now = npy("i.npy").data;
    if (ids.empty()) ids = now;
    EXPECT_EQ(now, ids) << extra;
    return json("s.json");
  };
  const auto plain = stats("");
  EXPECT_EQ(plain["device"], "threads");
  EXPECT_EQ(plain["isa"], std::string(name(available_isas().back())));

  const auto serial = stats("--device serial");
  EXPECT_EQ(serial["device"], "serial");
  EXPECT_EQ(serial["threads"], 1);
  for (const family::AxisInfo& r : family::rasterizer_axis())
    for (const family::AxisInfo& v : family::visibility_axis()) {
      if (r.name == "reference" && v.name != "atomic") continue;
      const auto s = stats("--rasterizer " + r.name + " --visibility " + v.name);
      EXPECT_EQ(s["rasterizer"], r.name);
      EXPECT_EQ(s["visibility"], v.name);
    }
  for (const std::string threads : {"1", "3"})
    EXPECT_EQ(stats("--rasterizer grouped --threads " + threads)["threads"].dump(), threads);
  for (const Isa isa : available_isas()) {
    const std::string isa_name(name(isa));
    EXPECT_EQ(stats("--rasterizer grouped --isa " + isa_name)["isa"], isa_name);
  }
  for (const auto& [limit, bytes] :
       {std::pair<std::string, int>{"8000000", 8000000}, {"8000K", 8000 * 1024}, {"8M", 8 << 20}})
    EXPECT_LE(stats("--threads 2 --memory-limit " + limit)["peak_bytes"], bytes);
  // A frame this small fits any limit, so limits that are too small are refused by their size.
  for (const auto& [limit, bytes] :
       {std::pair<std::string, std::string>{"1000", "1000"}, {"1K", "1024"}, {"1M", "1048576"}})
    refused(boxes + "-o p.png --memory-limit " + limit, "a memory limit of " + bytes + " bytes", 1);
  EXPECT_EQ(stats("--frames 3")["frame_ms"]["frames"], 3);
}

TEST_F(Options, ADeviceThatIsNotHereSaysSo) {
  const parallel::CudaStatus status = parallel::cuda_status();
  if (status.usable) GTEST_SKIP() << "there is a " << status.name;
  const std::string said = refused("render --look plain no-such-file.obj -o p.png --device cuda",
                                   "--device cuda: CUDA cannot be used: ", 1);
  EXPECT_TRUE(holds(said, "use --device threads"));
  EXPECT_FALSE(holds(said, "no-such-file")) << "it was read first";
  EXPECT_TRUE(holds(said, status.why_not));
}

TEST_F(Options, AnInstructionSetThatIsNotHereSaysSo) {
  const std::string isa(name(missing_isa()));
  for (const std::string device : {"serial", "threads", "auto"})
    for (const std::string line : {"render --look plain no-such-file.obj",
                                   "terrain --height no-such-file.png --shadows sharp"}) {
      const Outcome r = run(line + " -o p.png --device " + device + " --isa " + isa);
      EXPECT_EQ(r.status, 1);
      EXPECT_EQ(r.err.find("rastrum: error: --isa " + isa + ": "), 0U) << r.err;
    }
}

TEST_F(Options, AutoTakesADeviceAndSaysWhy) {
  must(
      "render --look plain builtin:boxes?count=2 --size 72x56 --device auto --stats auto.json -o "
      "auto.png");
  const auto s = json("auto.json");
  EXPECT_EQ(s["device"], "threads");  // with a GPU too, because the picture is small
  const parallel::CudaStatus status = parallel::cuda_status();
  const std::string why = s["device_why"];
  EXPECT_TRUE(holds(why, status.usable ? status.name : status.why_not));
  EXPECT_EQ(why.find(status.usable ? "there is a " : "no CUDA: "), 0U) << why;
  must("render --look plain builtin:boxes?count=2 --size 72x56 --stats asked.json");
  EXPECT_EQ(json("asked.json")["device_why"], "");
}

TEST_F(Options, QuietIsQuiet) {
  write("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 1 1\nf 1 2 3\nf 2 3 4\n");
  const Args args("render --look plain nan.obj -o p.png --size 16x16 --heatmap h.png");
  const std::string said = must(args);
  EXPECT_TRUE(holds(said, "warning: 1 of 2 triangles have a NaN"));
  EXPECT_TRUE(holds(said, "heatmap: "));
  EXPECT_TRUE(holds(said, "p.png: 16x16, 2 triangles"));
  EXPECT_EQ(must(args + "--quiet"), "");
}

}  // namespace
}  // namespace rastrum::test::options_test
