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

#include "tests/io/files.hpp"
#include "tests/support/painter.hpp"

namespace rastrum::test {
namespace fs = std::filesystem;
namespace {

/// In the child: becomes the command, or ends with 127.
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

void Program::SetUp() {
  std::string pattern = (fs::temp_directory_path() / "rastrum-apps-XXXXXX").string();
  ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
  folder_ = pattern;
}

void Program::TearDown() {
  fs::remove_all(folder_);
}

pid_t Program::start(const Args& command, Limits limits) const {
  const pid_t child = ::fork();
  // Beside the folder, so that the folder holds the program's own files alone.
  if (child == 0)
    become(command, limits, folder_, folder_.string() + ".out", folder_.string() + ".err");
  return child;
}

pid_t Program::start(const Args& args) const {
  Args command = Args{RASTRUM_PROGRAM} + args;
  return start(command, Limits{});
}

Outcome Program::wait(pid_t program) const {
  int status = 0;
  if (program < 0 || ::waitpid(program, &status, 0) != program) return {};
  const fs::path out = folder_.string() + ".out", err = folder_.string() + ".err";
  Outcome r{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), slurp(out),
            slurp(err)};
  fs::remove(out);
  fs::remove(err);
  return r;
}

Outcome Program::run(const Args& args, Limits limits) const {
  Args command = Args{RASTRUM_PROGRAM} + args;
  return wait(start(command, limits));
}

Outcome Program::shell(const std::string& script) const {
  ::setenv("RASTRUM", RASTRUM_PROGRAM, 1);
  return wait(start({"/bin/sh", "-c", script}, Limits{}));
}

void Program::refused(const Args& args, const std::string& part, int status) const {
  const Outcome r = run(args);
  EXPECT_EQ(r.status, status) << part << "\n" << r.err;
  EXPECT_TRUE(holds(r.err, part));
}

std::string Program::must(const Args& args) const {
  const Outcome r = run(args);
  std::string line;
  for (const std::string& a : args) line += " " + a;
  EXPECT_EQ(r.status, 0) << "rastrum" << line << "\n" << r.err;
  return r.err;
}

Args Program::files() const {
  Args names;
  for (const fs::directory_entry& e : fs::directory_iterator(folder_))
    names.push_back(e.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void Program::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
}

std::string Program::read(const std::string& name) const {
  return slurp(path(name));
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
