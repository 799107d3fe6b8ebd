#include "inputs.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include <rastrum/core/error.hpp>
#include <rastrum/io/io.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/scene/shapes/shapes.hpp>

#include "arguments.hpp"
#include "progress.hpp"
#include "timeline.hpp"

namespace rastrum::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBuiltin = "builtin:";

/// Where a builtin stands: scaled about its origin, then moved.
struct Placement {
  double x = 0, y = 0, z = 0, scale = 1;

  /// Whether `key` is one of the placement's names.
  bool set(const std::string& input, std::string_view key, std::string_view value) {
    for (const auto& [name, field] :
         {std::pair{"x", &x}, std::pair{"y", &y}, std::pair{"z", &z}, std::pair{"scale", &scale}}) {
      if (key != name) continue;
      *field = parse_number(input + ": " + name, value);
      if (scale == 0) throw UsageError(input, "scale must not be 0");
      return true;
    }
    return false;
  }
  [[nodiscard]] Mat4d matrix() const {
    Mat4d m = Mat4d::identity();
    for (int i = 0; i < 3; ++i) m.m[i][i] = scale;
    m.m[0][3] = x;
    m.m[1][3] = y;
    m.m[2][3] = z;
    return m;
  }
};

Scene make_builtin(const std::string& input) {
  const std::string_view spec = std::string_view(input).substr(kBuiltin.size());
  const std::size_t question = spec.find('?');
  std::string shape(spec.substr(0, question));
  Placement placement;
  char separator = '?';
  for (std::size_t begin = question; begin < spec.size();) {
    const std::size_t end = spec.find_first_of("&,", ++begin);
    const std::string_view item = spec.substr(begin, end - begin);
    begin = end;
    const std::size_t equals = item.find('=');
    if (equals != std::string_view::npos &&
        placement.set(input, item.substr(0, equals), item.substr(equals + 1)))
      continue;
    shape += std::exchange(separator, '&');
    shape += item;
  }
  Scene scene;
  try {
    scene.meshes.push_back(shapes::from_spec(shape));
  } catch (const Error& e) {
    if (e.code() == Errc::invalid_argument) throw UsageError(input, e.what());
    throw;
  }
  if (scene.meshes[0].name.empty()) scene.meshes[0].name = spec.substr(0, question);
  scene.instances.push_back({0, placement.matrix()});
  return scene;
}

/// Unindexed corners share nothing, so their vertex normals are the face normals that the renderer
/// takes anyway.
void choose_normals(Mesh& mesh, Normals normals) {
  const bool keep = normals == Normals::file && !mesh.normals.empty();
  if (keep) return;
  mesh.normals = {};
  if (normals != Normals::face && !mesh.indices.empty())
    mesh.normals.values = vertex_normals(mesh.positions, mesh.indices);
}

bool says_its_format(const std::string& input) {
  const std::string extension = fs::path(input).extension().string();
  return std::ranges::any_of(io::scene_formats(), [&](std::string_view format) {
    return std::ranges::equal(extension, "." + std::string(format), {},
                              [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  });
}

bool is_stdin(const std::string& input) {
  return input == "-" || input == "/dev/stdin";
}

/// Whether the input is a pipe, or has to be taken for one: nothing but `format` says what it is.
bool is_unnamed(const std::string& input, std::string_view format) {
  std::error_code ignored;
  if (input.starts_with(kBuiltin) || says_its_format(input) || fs::is_directory(input, ignored))
    return false;
  return is_stdin(input) || !format.empty() || fs::is_fifo(input, ignored);
}

}  // namespace

void check_inputs(const std::vector<std::string>& inputs, std::string_view format) {
  if (std::ranges::count_if(inputs, is_stdin) > 1)
    throw UsageError("INPUT", "standard input can be read once, and is asked for twice");
  for (const std::string& input : inputs)
    if (format.empty() && is_unnamed(input, format))
      throw UsageError(is_stdin(input) ? "standard input" : input,
                       "the name of a pipe does not say what it holds: say it, as in --format ply");
}

Scene load_input(const std::string& input, std::string_view format) {
  if (input.starts_with(kBuiltin)) return make_builtin(input);
  if (!is_unnamed(input, format)) return io::read_scene(input);
  check_inputs({input}, format);  // before it is opened, which would wait for who writes to it
  const io::MappedFile file(is_stdin(input) ? "/dev/stdin" : input);
  return io::decode_scene(file.bytes(), format, is_stdin(input) ? "standard input" : input);
}

Scene load_inputs(const std::vector<std::string>& inputs, Normals normals, Timeline& timeline,
                  Progress& progress, std::string_view format) {
  Scene scene;
  for (const std::string& input : inputs) {
    progress.show("loading " + input);
    timeline.measure("load " + input, "load", [&] { scene.append(load_input(input, format)); });
  }
  progress.show("computing normals");
  timeline.measure("normals", "load", [&] {
    for (Mesh& mesh : scene.meshes) choose_normals(mesh, normals);
  });
  return scene;
}

}  // namespace rastrum::cli
