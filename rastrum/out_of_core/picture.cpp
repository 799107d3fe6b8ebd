// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/out_of_core/picture.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include <rastrum/core/view_rows.hpp>
#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/ranks/gather.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/render/access.hpp>
#include <rastrum/render/target_checks.hpp>
#include <rastrum/render/tone_pass.hpp>
#include <rastrum/scene/mesh_clusters.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::out_of_core {
namespace {

/// Bytes per triangle while crease normals are made (crease_normals).
constexpr std::uint64_t kNormalBytes = 130;
/// The least and the most triangles of a chunk.
constexpr std::uint64_t kLeastChunk = 1, kMostChunk = std::uint64_t{1} << 22;
/// Bytes per triangle of a chunk. There are two chunks, with 12 bytes of indices and the mapped
/// faces.
constexpr std::uint64_t kChunkBytes = 96;

/// Bytes per triangle of a pixel whose layers may not fit: fragments take at most about 180, and
/// the renderer has a quarter of its scratch for them.
constexpr std::uint64_t kLayerBytes = 2000;

/// The least bytes beside the fixed ones.
constexpr std::uint64_t kLeastRest = std::uint64_t{24} << 20;

/// Bytes per part: place, box, instance and node, twice, because the reader makes them too.
constexpr std::uint64_t kPartBytes = 4096;

std::uint64_t bytes_of_targets(const Targets& targets) {
  std::uint64_t bytes = 0;
  ranks::each_target(targets, [&](const auto& view, std::uint32_t) {
    if (!view.empty())
      bytes += sizeof(*view.data) * static_cast<std::uint64_t>(view.width) *
               static_cast<std::uint64_t>(view.height);
  });
  return bytes;
}

/// Whether f() had enough memory.
template <class F>
bool has_memory(const F& f) {
  try {
    f();
    return true;
  } catch (const Error& e) {
    if (e.code() != Errc::out_of_memory) throw;
    return false;
  }
}

bool same(raster::Rect a, raster::Rect b) {
  return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

/// A part of an image; its first pixel becomes (0, 0).
template <class T>
ImageView<T> part_of(ImageView<T> view, raster::Rect part) {
  if (view.empty()) return view;
  return {&view(part.x0, part.y0), part.x1 - part.x0, part.y1 - part.y0, view.stride};
}
Targets part_of(Targets targets, raster::Rect part) {
  ranks::each_target(targets, [&](auto& view, std::uint32_t) { view = part_of(view, part); });
  return targets;
}
/// The inverse: pixels are at their places in the picture.
Targets placed(Targets part, raster::Rect at) {
  ranks::each_target(part, [&](auto& view, std::uint32_t) { view = raster::placed(view, at); });
  return part;
}

}  // namespace

io::FileSelection selection_of(const io::LargeFile& file,
                               std::span<const std::uint64_t> triangles) {
  constexpr std::uint64_t kFirst[] = {0};
  if (triangles.empty() && file.triangles() != 0) triangles = kFirst;
  return file.selection(triangles);
}

std::vector<std::uint64_t> list_of(const Marks& marks) {
  std::vector<std::uint64_t> triangles;
  triangles.reserve(marks.count());
  marks.for_each([&](std::uint64_t t) { triangles.push_back(t); });
  return triangles;
}

Scene scene_of(const io::LargeFile& file, const io::FileSelection& selection,
               FunctionRef<void(Scene&)> prepare) {
  file.check_length();
  Scene scene = io::decode_scene(selection.file, file.format(), file.name());
  if (prepare) prepare(scene);
  bool same = scene.instances.size() == selection.parts.size();
  for (std::size_t i = 0; same && i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    same = !instance.geometry && scene.meshes[instance.mesh].triangle_count() ==
                                     selection.meshes[selection.parts[i].mesh].size();
  }
  if (!same)
    throw Error(Errc::unsupported,
                file.name() + ": out of core: the reader makes other meshes of it");
  return scene;
}

/// Marks the triangles whose fragments it receives in a rectangle.
class Picture::Seen final : public raster::FragmentSink {
 public:
  /// `selection`: keys have its ids; null: the file's.
  Seen(Marks& marks, Rect rect, const io::FileSelection* selection = nullptr)
      : FragmentSink(raster::Translucent::keys_to_sink),
        marks_(marks),
        rect_(rect),
        selection_(selection) {}
  using FragmentSink::take;
  void take(const raster::FragmentPlane& plane) override {
    const int x = plane.bx * raster::kBlockSize, y = plane.by * raster::kBlockSize;
    if (x >= rect_.x1 || x + raster::kBlockSize <= rect_.x0 || y >= rect_.y1 ||
        y + raster::kBlockSize <= rect_.y0)
      return;
    const std::uint64_t inside = raster::samples_inside(rect_, plane.bx, plane.by);
    const bool counts = !layers.empty() && plane.sample == 0 && !plane.opaque;
    for (std::uint64_t m = plane.mask & inside; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      mark(plane.keys[i]);
      if (counts) ++layers(x + i % raster::kBlockSize, y + i / raster::kBlockSize);
    }
  }
  ImageView<std::uint32_t> layers{};  ///< counts layers, if not empty; in the picture's coordinates
  void mark(std::uint64_t key) {
    const std::uint64_t id = raster::id_of_key(key);
    marks_.add_shared(selection_ == nullptr ? id : selection_->original(id));
  }

 private:
  Marks& marks_;
  Rect rect_;
  const io::FileSelection* selection_;
};

Picture::Picture(const io::LargeFile& file, const Camera& camera, const FrameOptions& frame,
                 const Targets& targets, const OutOfCoreOptions& options)
    : file_(file), camera_(camera), frame_(frame), targets_(targets), options_(options) {}

void Picture::check() const {
  rastrum::check(frame_);
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw Error(Errc::unsupported, std::string("out of core: ").append(what));
  };
  require(!frame_.shadows, "shadows need all triangles at once; draw without");
  require(frame_.shader != Shader::id,
          "the shader 'id' needs the ids of the whole file; take the target ids");
  require(options_.renderer.device != Device::cuda,
          "only the CPU draws; take Device::threads or Device::serial");
  require(targets_.keys.empty() && targets_.overdraw.empty() && targets_.extra.empty() &&
              targets_.errors.empty() && targets_.ids32.empty() && targets_.instances32.empty() &&
              targets_.primitives32.empty(),
          "the targets keys, overdraw, errors and extra are not filled, and ids have 64 bits");
  require(is_whole() || !frame_.environment_behind,
          "the environment behind a picture in bands of rows is not drawn");
  require(is_whole() || frame_.shader != Shader::depth,
          "the shader depth stretches the depths of a whole picture, not of bands of rows");
  check_band_rows(options_.rows);
  if (!is_whole())
    ranks::each_target(targets_, [&](const auto& view, std::uint32_t) {
      check_size(view, frame_.width, std::min(options_.rows, frame_.height),
                 "a target of a band of rows");
    });
  check_bands_taken(options_.rows, frame_.height, static_cast<bool>(options_.take_rows));
}

void Picture::divide_memory() {
  const int rows = is_whole() ? frame_.height : std::min(options_.rows, frame_.height);
  const auto pixels = static_cast<std::uint64_t>(frame_.width) * static_cast<std::uint64_t>(rows);
  const bool needs_ids =
      !targets_.primitives.empty() && targets_.ids.empty() && file_.parts().size() > 1;
  budget_.fixed = bytes_of_targets(targets_) + pixels * (needs_ids ? 20 : 12) +
                  file_.triangles() / 8 + file_.vertices() / 6 + file_.bytes_beside() +
                  file_.parts().size() * kPartBytes;
  if (options_.memory_limit < budget_.fixed + kLeastRest) refuse_memory(budget_.fixed + kLeastRest);
  const std::uint64_t rest = options_.memory_limit - budget_.fixed;
  budget_.scratch = rest / 8 * 3;
  budget_.triangles = rest - budget_.scratch;
  std::uint64_t chunk = options_.chunk_triangles;
  if (chunk == 0) chunk = budget_.triangles / 2 / kChunkBytes;
  chunk = std::clamp(chunk, kLeastChunk, kMostChunk);
  stats_.chunk = std::min(chunk, file_.triangles());
  chunks_.emplace(file_, stats_.chunk, budget_.triangles / 4);
}

void Picture::refuse_memory(std::uint64_t needed) const {
  throw Error(Errc::out_of_memory,
              file_.name() + ": out of core: a memory limit of " +
                  std::to_string(options_.memory_limit) + " bytes is too little, about " +
                  std::to_string(needed) + " are needed; a smaller picture needs less" +
                  (options_.neighbours ? ", and so do normals of faces or of the file" : ""));
}

std::uint64_t Picture::bytes_of(std::uint64_t triangles) const {
  return triangles * (file_.bytes_a_triangle() + 8 + (options_.neighbours ? kNormalBytes : 0));
}

bool Picture::fits_at_once(std::uint64_t triangles) const {
  return bytes_of(triangles) <= budget_.triangles &&
         (options_.band_triangles == 0 || triangles <= options_.band_triangles);
}

OutOfCoreStats Picture::draw() {
  check();
  stats_.triangles = file_.triangles();
  divide_memory();
  RendererOptions of_renderer = options_.renderer;
  of_renderer.memory_limit = budget_.scratch;
  renderer_.emplace(of_renderer);
  threads_.emplace(options_.renderer.threads);
  marks_.emplace(file_.triangles());
  sample_ = scene_of(file_, selection_of(file_, {}), options_.prepare);
  sample_view_.emplace(sample_);
  const SceneView sample = sample_view_->view();
  if (frame_.shader == Shader::automatic) frame_.shader = shader_for(frame_.shader, sample);
  unlit_ = frame_;
  unlit_.lights.clear();
  unlit_.tone = {};
  unlit_.environment_behind = false;
  if (unlit_.shader == Shader::depth) {
    unlit_.shader = Shader::flat;
    unlit_.transparency.method = Transparency::none;
  }
  for (const InstanceView& part : sample.instances)
    views_.emplace_back(world_to_clip(camera_, frame_.width, frame_.height) * part.object_to_world,
                        false, raster::Viewport::of(frame_.width, frame_.height));
  const int rows = is_whole() ? frame_.height : options_.rows;
  for (int y = 0; y < frame_.height; y += rows) {
    band_ = {0, y, frame_.width, std::min(y + rows, frame_.height)};
    draw_band();
    if (!is_whole() && options_.take_rows) options_.take_rows(band_.y0, band_.y1);
  }
  chunks_.reset();
  return stats_;
}

void Picture::draw_band() {
  keys_ = Image<std::uint64_t>(frame_.width, band_.y1 - band_.y0);
  layers_ = Image<std::uint32_t>(frame_.width, band_.y1 - band_.y0);
  keys_are_whole_ = translucent_ = false;
  draw(band_);
}

ImageView<const std::uint64_t> Picture::keys() const {
  return ranks::in_place<const std::uint64_t>(keys_.view(), band_.y0);
}

raster::Rect Picture::bins_of(Rect rect) const {
  constexpr int kSide = raster::kBinSize;
  return {rect.x0 / kSide * kSide, rect.y0 / kSide * kSide,
          std::min((rect.x1 + kSide - 1) / kSide * kSide, band_.x1),
          std::min((rect.y1 + kSide - 1) / kSide * kSide, band_.y1)};
}

// ---- Visible triangles

void Picture::survey(const MeshView& triangles, std::size_t part, std::uint64_t first_id, Rect rect,
                     raster::FragmentSink& sink) {
  const std::size_t count = triangles.triangle_count(), half = count / 2;
  // A failed attempt leaves only keys and marks that its halves leave as well.
  if (count < 2) return survey_at_once(triangles, part, first_id, rect, sink);
  if (has_memory([&] { survey_at_once(triangles, part, first_id, rect, sink); })) return;
  const std::pair<std::size_t, std::size_t> halves[] = {{0, half}, {half, count}};
  for (const auto& [begin, end] : halves) {
    MeshView some = triangles;
    std::vector<std::uint32_t> corners;
    if (some.indices.empty()) {
      corners.resize(3 * (end - begin));
      std::iota(corners.begin(), corners.end(), static_cast<std::uint32_t>(3 * begin));
      some.indices = corners;
    } else {
      some.indices = some.indices.subview(3 * begin, 3 * (end - begin));
    }
    survey(some, part, first_id + begin, rect, sink);
  }
}

void Picture::survey_at_once(MeshView mesh, std::size_t part, std::uint64_t first_id, Rect rect,
                             raster::FragmentSink& sink) {
  SceneView scene = sample_view_->view();
  InstanceView instance = scene.instances[part];
  const MeshView& like = *instance.mesh();
  mesh.material = like.material;
  // One translucent colour makes all vertices translucent here; which ones are does not matter.
  Vec4 color{1, 1, 1, 1};
  if (!like.colors.empty()) {
    for (std::size_t i = 0; i < like.colors.values.size(); ++i)
      if (!(like.colors.values[i].w >= 1)) color = like.colors.values[i];
    mesh.colors.values = ArrayView<Vec4>::of(&color.x, mesh.positions.size(), 0);
  }
  instance.geometry = mesh;
  scene.instances = {&instance, 1};
  Targets targets;
  Image<std::uint64_t> unused;
  Pass pass{.first_id = first_id};
  const Rect bins = bins_of(rect);
  if (frame_.samples == 1) {
    targets.keys = ranks::in_place(keys_.view(), band_.y0);
    pass.load = true;
  } else {
    unused = Image<std::uint64_t>(bins.x1 - bins.x0, bins.y1 - bins.y0);
    targets.keys = raster::placed(unused.view(), bins);
  }
  RendererAccess::Apart apart{.sink = &sink};
  if (!same(bins, picture())) apart.part = bins;
  const FrameStats stats =
      RendererAccess::render(*renderer_, scene, camera_, unlit_, targets, pass, apart);
  if (frame_.samples == 1) translucent_ |= stats.visibility == "layers";
  stats_.dropped += stats.triangles.dropped;
}

bool Picture::is_in_sight(const io::FileBox& box, std::size_t part, Rect rect) const {
  const raster::BoxPlace at = views_[part].place(box.min, box.max);
  const Rect& p = at.pixels;
  return !at.outside &&
         (!at.whole || (p.x1 > rect.x0 && p.x0 < rect.x1 && p.y1 > rect.y0 && p.y0 < rect.y1));
}

void Picture::sift(Rect rect) {
  const io::FileSelection small = selection_of(file_, list_of(*marks_));
  const Scene scene = scene_of(file_, small, {});
  marks_->clear();
  Seen seen(*marks_, rect, &small);
  const std::uint64_t dropped = stats_.dropped;
  for (std::size_t part = 0; part < small.parts.size(); ++part) {
    const Mesh& mesh = scene.meshes[scene.instances[part].mesh];
    MeshView bare;
    bare.positions = mesh.view().positions;
    bare.indices = mesh.indices;
    survey(bare, part, small.parts[part].id, rect, seen);
  }
  stats_.dropped = dropped;
}

bool Picture::keys_hide() const {
  // Some ways of blending show what lies behind.
  const Transparency method = frame_.transparency.method;
  return frame_.samples == 1 && !translucent_ &&
         (method == Transparency::exact || method == Transparency::none);
}

std::vector<std::size_t> Picture::order() const {
  const std::vector<Chunks::Place>& places = chunks_->places();
  std::vector<std::size_t> order = chunks_->in_file();
  if (!keys_hide()) return order;
  // Any order gives the same bits: keys are maxima, and marks are a set.
  std::vector<float> nearest(places.size(), std::numeric_limits<float>::infinity());
  for (const Chunks::Place& at : places)
    if (const std::optional<io::FileBox> box = chunks_->box(at))
      if (const raster::BoxPlace place = views_[at.part].place(box->min, box->max); place.whole)
        nearest[at.number] = place.highest;
  std::ranges::stable_sort(order, std::ranges::greater{},
                           [&](std::size_t i) { return nearest[i]; });
  return order;
}

bool Picture::is_hidden(const io::FileBox& box, const Chunks::Place& at) const {
  if (!keys_hide()) return false;
  const raster::BoxPlace place = views_[at.part].place(box.min, box.max);
  MeshCluster cluster;
  cluster.longest_edge = file_.longest_edge(at.first, at.count);
  if (!place.whole || !(cluster.longest_edge < std::numeric_limits<float>::infinity()))
    return false;
  const float highest = views_[at.part].highest_sample(cluster, place);
  const int x0 = std::max(place.pixels.x0, 0), x1 = std::min(place.pixels.x1, frame_.width);
  const int y0 = std::max(place.pixels.y0, band_.y0), y1 = std::min(place.pixels.y1, band_.y1);
  const ImageView<const std::uint64_t> nearest = keys();
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      if (!(highest < raster::depth_of_key(nearest(x, y)))) return false;
  return true;
}

void Picture::find_by_chunks(Rect rect) {
  std::ranges::fill(keys_.pixels(), 0);
  marks_->clear();
  stats_.dropped = 0;
  std::uint64_t sifted = 0, looked_at = 0;
  std::uint64_t at_most = 0;  // bounds the marks; we count them only when it gets too large
  chunks_->walk(
      order(),
      [&](const io::FileChunk& chunk, const Chunks::Place& at) {
        MeshView mesh;
        mesh.positions = chunk.positions;
        mesh.indices = chunk.indices;
        Seen seen(*marks_, rect);
        if (same(rect, band_)) seen.layers = ranks::in_place(layers_.view(), band_.y0);
        survey(mesh, at.part, chunk.first, rect, seen);
        looked_at += chunk.count;
        tell("looking for what is seen", looked_at, file_.triangles());
        if (frame_.samples == 1) return;
        // With several samples, marks are the winners within each chunk.
        at_most += chunk.count;
        const auto is_to_sift = [&](std::uint64_t count) {
          return bytes_of(count) <= budget_.triangles &&
                 (bytes_of(count - sifted) > budget_.triangles / 4 || !fits_at_once(count));
        };
        if (!is_to_sift(at_most) && fits_at_once(at_most)) return;
        at_most = marks_->count();
        if (!is_to_sift(at_most)) return;
        sift(rect);
        at_most = sifted = marks_->count();
      },
      [&](const Chunks::Place& at) {
        const std::optional<io::FileBox> box = chunks_->box(at);
        return !box || (is_in_sight(*box, at.part, rect) && !is_hidden(*box, at));
      });
}

bool Picture::find(Rect rect) {
  if (!keys_are_whole_) {
    find_by_chunks(rect);
    keys_are_whole_ = frame_.samples == 1 && !translucent_;
  }
  if (frame_.samples == 1) {
    if (keys_are_whole_) marks_->clear();
    Seen seen(*marks_, rect);
    const ImageView<const std::uint64_t> nearest = keys();
    for (int y = rect.y0; y < rect.y1; ++y)
      for (int x = rect.x0; x < rect.x1; ++x)
        if (const std::uint64_t key = nearest(x, y); key != 0) seen.mark(key);
  }
  seen_ = marks_->count();
  if (!fits_at_once(seen_)) return false;
  if (!options_.neighbours || seen_ == 0) return true;
  mark_neighbours(file_, *chunks_, *threads_, *marks_, [&](std::uint64_t done, std::uint64_t all) {
    tell("looking for neighbours", done, all);
  });
  seen_ = marks_->count();
  return fits_at_once(seen_);
}

// ---- The picture of marked triangles

void Picture::draw(Rect rect) {
  const bool fits = find(rect);
  stats_.chunks = chunks_->read();
  stats_.skipped = chunks_->left_out();
  if (fits && draw_marked(rect)) return;
  std::uint64_t pieces = bytes_of(seen_) / budget_.triangles;
  if (options_.band_triangles != 0) pieces = std::max(pieces, seen_ / options_.band_triangles);
  if (same(rect, band_)) try_deepest();
  split(rect, pieces * 5 / 4 + 2);
}

void Picture::try_deepest() {
  const auto pixels = layers_.pixels();
  const auto deepest = std::ranges::max_element(pixels);
  if (*deepest * kLayerBytes <= budget_.scratch + budget_.triangles) return;
  const auto at = static_cast<int>(deepest - pixels.begin());
  const int x = at % frame_.width, y = band_.y0 + at / frame_.width;
  const OutOfCoreStats before = stats_;
  draw({x, y, x + 1, y + 1});
  stats_ = before;  // drawn again with its surroundings
}

void Picture::split(Rect rect, std::uint64_t pieces) {
  // Into rows of bins, then bins, then parts of a bin, which draw the whole bin with fewer
  // triangles.
  const int width = rect.x1 - rect.x0, height = rect.y1 - rect.y0;
  if ((width == 1 && height == 1) || frame_.shader == Shader::depth)
    refuse_memory(budget_.fixed + kLeastRest + std::max(bytes_of(seen_) * 2, seen_ * kLayerBytes));
  const bool is_bin = width <= raster::kBinSize && height <= raster::kBinSize;
  const bool down = is_bin ? height >= width : height > raster::kBinSize;
  const int side = is_bin ? 1 : raster::kBinSize;
  int& begin = down ? rect.y0 : rect.x0;
  int& end = down ? rect.y1 : rect.x1;
  const int first = begin, last = end, sides = (last - first + side - 1) / side;
  const int n = static_cast<int>(std::min<std::uint64_t>(pieces, static_cast<unsigned>(sides)));
  for (int i = 0; i < n; ++i) {
    begin = first + sides * i / n * side;
    end = std::min(first + sides * (i + 1) / n * side, last);
    draw(rect);
  }
}

bool Picture::draw_marked(Rect rect) {
  tell("drawing what is seen", 0, 1);
  const io::FileSelection small = selection_of(file_, list_of(*marks_));
  const Scene scene = scene_of(file_, small, options_.prepare);
  const Targets all = is_whole() ? targets_ : ranks::in_place(targets_, band_.y0);
  // An environment behind the surfaces needs a draw of the whole picture.
  const Rect part = frame_.environment_behind ? picture() : bins_of(rect);
  const bool in_place = same(part, rect);
  const std::uint32_t asked = ranks::targets_asked(targets_) | ranks::kKnownTargets;
  const ranks::OwnImages images(in_place ? 0 : asked, part);
  const Targets own = images.targets();
  const auto draw_it = [&] { draw_selection(scene, small, in_place ? all : own, part); };
  if (keys_are_whole_)
    draw_it();  // without layers it fits
  else if (!has_memory(draw_it))
    return false;
  ++stats_.bands;
  stats_.seen += marks_->count();
  if (in_place) {
    stats_.pixels_covered += stats_.frame.pixels_covered;
    return true;
  }
  const Targets from_part = part_of(own, rect), to_part = part_of(all, rect);
  raster::for_each_target([&](const auto& row) {
    const auto &from = from_part.*row.image, &to = to_part.*row.image;
    if (!row.has_ranks() || to.empty()) return;
    for (int y = 0; y < to.height; ++y) std::copy_n(from.row(y), from.width, to.row(y));
  });
  for (int y = 0; y < from_part.ids.height; ++y)
    stats_.pixels_covered += static_cast<std::uint64_t>(
        std::count_if(from_part.ids.row(y), from_part.ids.row(y) + from_part.ids.width,
                      [](std::int64_t id) { return id >= 0; }));
  return true;
}

void Picture::draw_selection(const Scene& scene, const io::FileSelection& selection,
                             Targets targets, Rect part) {
  const SceneBinding binding(scene);
  Image<std::int64_t> ids;
  // A primitive's number needs its part's id to be unique.
  if (!targets.primitives.empty() && targets.ids.empty() && selection.parts.size() > 1) {
    ids = Image<std::int64_t>(part.x1 - part.x0, part.y1 - part.y0);
    targets.ids = raster::placed(ids.view(), part);
  }
  if (same(part, picture()))
    stats_.frame = renderer_->render(binding.view(), camera_, frame_, targets);
  else
    draw_part(binding.view(), part, targets);
  for (int y = part.y0; y < part.y1; ++y) {
    if (!targets.primitives.empty())
      for (int x = part.x0; x < part.x1; ++x)
        if (std::int64_t& primitive = targets.primitives(x, y); primitive >= 0) {
          const auto id =
              static_cast<std::uint64_t>(targets.ids.empty() ? primitive : targets.ids(x, y));
          primitive =
              static_cast<std::int64_t>(selection.original(id) - selection.part_of(id).first);
        }
    if (!targets.ids.empty())
      for (int x = part.x0; x < part.x1; ++x)
        if (std::int64_t& id = targets.ids(x, y); id >= 0)
          id = static_cast<std::int64_t>(selection.original(static_cast<std::uint64_t>(id)));
  }
}

void Picture::draw_part(const SceneView& scene, Rect part, const Targets& all) {
  FrameOptions held = frame_, untoned = frame_;
  held.width = part.x1 - part.x0;
  held.height = part.y1 - part.y0;
  untoned.tone = {};
  TonePass tone;
  const Targets asked = part_of(all, part);
  const bool tones = TonePass::wanted(frame_, asked, frame_.shader);
  const Targets targets = placed(tones ? tone.targets(held, asked) : asked, part);
  stats_.frame =
      RendererAccess::render(*renderer_, scene, camera_, untoned, targets, {}, {.part = part});
  if (tones) tone.draw(held, asked, RendererAccess::threads(*renderer_));
}

}  // namespace rastrum::out_of_core
