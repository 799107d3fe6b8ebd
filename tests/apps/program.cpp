// SPDX-License-Identifier: BSD-3-Clause
#include "program.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#ifdef RASTRUM_HAS_OPENEXR
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#endif

#include <rastrum/fit.hpp>
#include <rastrum/io.hpp>

#include "tests/support/painter.hpp"

namespace rastrum::test {
namespace fs = std::filesystem;
namespace {

/// In the child: executes the command, or exits with 127.
[[noreturn]] void become(const Args& command, Limits limits, const fs::path& folder,
                         const fs::path& out, const fs::path& err) {
  std::vector<char*> argv;
  for (const std::string& a : command) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  if (::chdir(folder.c_str()) != 0) ::_exit(127);
  const int o = limits.stdout_full ? ::open("/dev/full", O_WRONLY)
                                   : ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  const int e = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (o < 0 || e < 0 || ::dup2(o, 1) < 0 || ::dup2(e, 2) < 0) ::_exit(127);
  if (limits.file_bytes >= 0) {
    std::signal(SIGXFSZ, SIG_IGN);  // write() then fails instead
    const auto bytes = static_cast<rlim_t>(limits.file_bytes);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

}  // namespace

pid_t Program::start(const Args& command, Limits limits) const {
  const pid_t child = ::fork();
  if (child == 0) become(command, limits, path(""), beside(".out"), beside(".err"));
  return child;
}

pid_t Program::start(const Args& args) const {
  return start(Args{RASTRUM_PROGRAM} + args, Limits{});
}

Outcome Program::wait(pid_t program) const {
  int status = 0;
  if (program < 0 || ::waitpid(program, &status, 0) != program) return {};
  const fs::path out = beside(".out"), err = beside(".err");
  Outcome r{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), slurp(out),
            slurp(err)};
  fs::remove(out);
  fs::remove(err);
  return r;
}

Outcome Program::run(const Args& args, Limits limits) const {
  return wait(start(Args{RASTRUM_PROGRAM} + args, limits));
}

Outcome Program::shell(const std::string& script) const {
  ::setenv("RASTRUM", RASTRUM_PROGRAM, 1);
  return wait(start({"/bin/sh", "-c", script}, Limits{}));
}

std::string Program::refused(const Args& args, const std::string& part, int status) const {
  const Outcome r = run(args);
  EXPECT_EQ(r.status, status) << part << "\n" << r.err;
  EXPECT_TRUE(holds(r.err, part)) << "rastrum" << args;
  return r.err;
}

std::string Program::must(const Args& args) const {
  const Outcome r = run(args);
  EXPECT_EQ(r.status, 0) << "rastrum" << args << "\n" << r.err;
  return r.err;
}

Image<Rgba8> Program::drawn(const Args& args) const {
  must(args + "-o drawn.png");
  Image<Rgba8> picture = png("drawn.png");
  fs::remove(path("drawn.png"));
  return picture;
}

void Program::expect_film(const Args& args, int pictures, const std::string& width_height,
                          double most) const {
  if (shell("command -v ffmpeg ffprobe").status != 0)
    GTEST_SKIP() << "ffmpeg is missing (Debian: ffmpeg)";
  must(args + "-o v.mp4");
  must(args + "-o f%d.png");
  const Outcome r = shell(
      "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
      "stream=width,height,nb_read_frames -of csv=p=0 v.mp4 && ffmpeg -loglevel error -i v.mp4 "
      "-vf scale=in_color_matrix=bt709 -pix_fmt rgba v%d.png");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(r.out, width_height + "," + std::to_string(pictures) + "\n");
  EXPECT_FALSE(fs::exists(path("f" + std::to_string(pictures) + ".png")));
  for (int i = 0; i < pictures; ++i) {  // ffmpeg counts from 1
    const Image<Rgba8> a = png("f" + std::to_string(i) + ".png");
    const Image<Rgba8> b = png("v" + std::to_string(i + 1) + ".png");
    double sum = 0;
    for (std::size_t k = 0; k < a.pixels().size(); ++k)
      sum += std::abs(a.pixels()[k].r - b.pixels()[k].r) +
             std::abs(a.pixels()[k].g - b.pixels()[k].g) +
             std::abs(a.pixels()[k].b - b.pixels()[k].b);
    // Compressed and with a quarter of the colours: close on average, and the same picture.
    EXPECT_LT(sum / static_cast<double>(a.pixels().size()), most) << i;
  }
}

void Program::run_line(const std::string& line) const {
  ASSERT_TRUE(line.starts_with("rastrum ")) << line;
  const std::string rest = line.substr(std::string("rastrum").size(), line.size() - 8);
  const Outcome r = shell("\"$RASTRUM\"" + rest + " --quiet");
  EXPECT_EQ(r.status, 0) << line << r.err;
}

Args Program::files() const {
  Args names;
  for (const fs::directory_entry& e : fs::directory_iterator(path("")))
    names.push_back(e.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

nlohmann::ordered_json Program::json(const std::string& name) const {
  return nlohmann::ordered_json::parse(read(name));
}

Image<Rgba8> Program::png(const std::string& name) const {
  return io::read_image(path(name));
}

Program::Npy Program::npy(const std::string& name) const {
  const std::string file = read(name);
  if (file.substr(0, 8) != std::string("\x93NUMPY\x01\x00", 8)) return {};
  const std::size_t length =
      static_cast<unsigned char>(file[8]) + 256U * static_cast<unsigned char>(file[9]);
  return {file.substr(10, length), file.substr(10 + length)};
}

std::vector<std::vector<float>> Program::exr(const std::string& name, const Args& channels) const {
  std::vector<std::vector<float>> planes;
#ifdef RASTRUM_HAS_OPENEXR
  Imf::InputFile file(path(name).c_str());
  const Imath::Box2i window = file.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x + 1);
  const auto height = static_cast<std::size_t>(window.max.y + 1);
  planes.assign(channels.size(), std::vector<float>(width * height));
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Imf::Channel* channel = file.header().channels().findChannel(channels[c]);
    EXPECT_TRUE(channel != nullptr && channel->type == Imf::FLOAT) << channels[c];
    frame.insert(channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(planes[c].data()),
                                         sizeof(float), sizeof(float) * width));
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
#else
  (void)name;
  (void)channels;
#endif
  return planes;
}

Drawn draw(const Scene& scene, const Camera& camera, const RenderOptions& options) {
  Drawn d{Image<Rgba8>(options.width, options.height),
          Image<Vec4>(options.width, options.height),
          Image<float>(options.width, options.height),
          Image<std::int64_t>(options.width, options.height),
          {}};
  Painter renderer(options);
  d.stats = renderer.render(SceneBinding(scene).view(), camera,
                            {.color8 = d.color8, .color = d.color, .depth = d.depth, .ids = d.ids});
  return d;
}

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.emplace_back();
  return scene;
}

Camera fit(const Scene& scene, const RenderOptions& options) {
  return fit_picture(SceneBinding(scene).view(), {}, options.width, options.height);
}

}  // namespace rastrum::test
