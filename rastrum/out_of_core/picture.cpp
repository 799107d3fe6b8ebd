#include <rastrum/out_of_core/picture.hpp>

#include <algorithm>
#include <bit>
#include <future>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/ranks/gather.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/setup/piece.hpp>
#include <rastrum/render/access.hpp>
#include <rastrum/render/tone_pass.hpp>
#include <rastrum/scene/mesh_clusters.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::out_of_core {
namespace {

/// Of a triangle in the making of normals with creases (crease_normals).
constexpr std::uint64_t kNormalBytes = 130;
/// A chunk's least and most.
constexpr std::uint64_t kLeastChunk = 1, kMostChunk = std::uint64_t{1} << 22;
/// A triangle of a chunk: two of them are there, 12 bytes of indices and what is mapped of faces.
constexpr std::uint64_t kChunkBytes = 96;

/// Of a part: its place, box, instance and node, twice, as the reader makes them.
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

}  // namespace

io::FileSelection selection_of(const io::LargeFile& file,
                               std::span<const std::uint64_t> triangles) {
  constexpr std::uint64_t kFirst[] = {0};
  if (triangles.empty() && file.triangles() != 0) triangles = kFirst;
  return file.selection(triangles);
}

Scene scene_of(const io::LargeFile& file, const io::FileSelection& selection,
               const std::function<void(Scene&)>& prepare) {
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

Chunks::Chunks(const io::LargeFile& file, std::uint64_t triangles, std::size_t vertex_bytes)
    : file_(file), vertex_bytes_(vertex_bytes) {
  triangles = std::max<std::uint64_t>(triangles, 1);
  for (std::size_t part = 0; part < file.parts().size(); ++part) {
    const auto [first, count] = file.parts()[part];
    for (std::uint64_t t = 0; t < count; t += triangles)
      places_.push_back({places_.size(), part, first + t, std::min(triangles, count - t)});
  }
  boxes_.resize(places_.size());
  in_file_.resize(places_.size());
  std::iota(in_file_.begin(), in_file_.end(), std::size_t{0});
}

void Chunks::walk(std::span<const std::size_t> order, const Work& f, const Wanted& wanted) {
  std::size_t next = 0;
  const auto begin = [&](io::FileChunk& chunk) -> std::future<void> {
    while (next < order.size()) {
      const Place& at = places_[order[next]];
      ++next;
      if (wanted && !wanted(at)) {
        ++left_out_;
        continue;
      }
      ++read_;
      return std::async(std::launch::async, [this, &at, &chunk] {
        file_.read(at.first, static_cast<std::size_t>(at.count), vertex_bytes_, chunk);
        std::optional<io::FileBox>& box = boxes_[at.number];
        if (box || file_.box(at.first, at.count)) return;
        box.emplace();
        for (std::size_t v = 0; v < chunk.positions.size(); ++v) box->add(chunk.positions.wide(v));
      });
    }
    return {};
  };
  int now = 0;
  std::future<void> coming = begin(two_[0]);
  while (coming.valid()) {
    coming.get();
    parallel::throw_if_stopped();
    const io::FileChunk& chunk = two_[now];
    const Place& at = places_[order[next - 1]];
    now = 1 - now;
    coming = begin(two_[now]);  // its destructor waits where f throws
    f(chunk, at);
    file_.check_length();  // positions are read where they lie
    file_.drop(chunk);
  }
}

std::optional<io::FileBox> Chunks::box(const Place& chunk) const {
  std::optional<io::FileBox> box = boxes_[chunk.number];
  if (!box) box = file_.box(chunk.first, chunk.count);
  if (box && (!box->finite || box->empty())) return {};
  return box;
}

/// Marks the triangles whose fragments it is given, of the pixels of some rows.
class Picture::Seen final : public raster::FragmentSink {
 public:
  /// `selection`: of what a key's ids are; null: of the file.
  Seen(Marks& marks, Rows rows, const io::FileSelection* selection = nullptr)
      : FragmentSink(Takes::keys), marks_(marks), rows_(rows), selection_(selection) {}
  using FragmentSink::take;
  void take(const raster::FragmentPlane& plane) override {
    const int y = plane.by * raster::kBlockSize;
    if (y >= rows_.end || y + raster::kBlockSize <= rows_.begin) return;
    for (std::uint64_t m = plane.mask; m != 0; m &= m - 1) mark(plane.keys[std::countr_zero(m)]);
  }
  void mark(std::uint64_t key) {
    const std::uint64_t id = raster::id_of_key(key);
    marks_.set(selection_ == nullptr ? id : selection_->original(id));
  }

 private:
  Marks& marks_;
  Rows rows_;
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
          "the shader 'id' is of a whole file's ids; take the target of ids");
  require(options_.renderer.device != Device::cuda, "frames are the CPU's");
  require(targets_.keys.empty() && targets_.overdraw.empty() && targets_.extra.empty() &&
              targets_.errors.empty() && targets_.ids32.empty() && targets_.instances32.empty() &&
              targets_.primitives32.empty(),
          "there are no targets keys, overdraw, errors and extra, and ids of 64 bits alone");
  require(!targets_.load && !targets_.over && targets_.first_id == 0,
          "a picture is drawn at once (load, over, first_id)");
  require(is_whole() || !frame_.environment_behind,
          "what is behind a picture in bands of rows is not drawn");
  require(is_whole() || frame_.shader != Shader::depth,
          "the shader depth stretches the depths of a whole picture, not of bands of rows");
  if (options_.rows < 0 || options_.rows % raster::kBinSize != 0)
    throw Error(Errc::invalid_argument,
                "rows: " + std::to_string(options_.rows) +
                    " rows at once; give a multiple of 64, or 0 for all of the picture");
  if (!is_whole())
    ranks::each_target(targets_, [&](const auto& view, std::uint32_t) {
      check_size(view, frame_.width, std::min(options_.rows, frame_.height),
                 "a target of a band of rows");
    });
}

void Picture::divide_memory() {
  const int rows = is_whole() ? frame_.height : std::min(options_.rows, frame_.height);
  const auto pixels = static_cast<std::uint64_t>(frame_.width) * static_cast<std::uint64_t>(rows);
  const bool needs_ids =
      !targets_.primitives.empty() && targets_.ids.empty() && file_.parts().size() > 1;
  const std::uint64_t fixed = bytes_of_targets(targets_) + 8 * pixels * (needs_ids ? 2 : 1) +
                              file_.triangles() / 8 + file_.vertices() / 6 + file_.bytes_beside() +
                              file_.parts().size() * kPartBytes;
  constexpr std::uint64_t kLeastRest = std::uint64_t{24} << 20;
  if (options_.memory_limit < fixed + kLeastRest) refuse_memory(fixed + kLeastRest);
  const std::uint64_t rest = options_.memory_limit - fixed;
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
    band_ = {y, std::min(y + rows, frame_.height)};
    draw_band();
    if (!is_whole() && options_.take_rows) options_.take_rows(band_.begin, band_.end);
  }
  chunks_.reset();
  return stats_;
}

void Picture::draw_band() {
  keys_ = Image<std::uint64_t>(frame_.width, band_.end - band_.begin);
  keys_are_whole_ = translucent_ = false;
  draw(band_);
}

ImageView<const std::uint64_t> Picture::keys() const {
  return ranks::in_place<const std::uint64_t>(keys_.view(), band_.begin);
}

// ---- what is seen

void Picture::survey(const MeshView& triangles, std::size_t part, std::uint64_t first_id,
                     raster::FragmentSink& sink) {
  SceneView scene = sample_view_->view();
  InstanceView instance = scene.instances[part];
  MeshView mesh = triangles;
  const MeshView& like = *instance.mesh();
  mesh.material = like.material;
  // Whether colours are translucent is asked of all of them; which is not.
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
  targets.first_id = first_id;
  if (frame_.samples == 1) {
    targets.keys = keys_;
    targets.load = true;
  } else {
    unused = Image<std::uint64_t>(frame_.width, keys_.height());
    targets.keys = unused;
  }
  RendererAccess::Apart apart{.sink = &sink};
  if (!is_whole()) apart.part = rect_of(band_);
  const FrameStats stats =
      RendererAccess::render(*renderer_, scene, camera_, unlit_, targets, apart);
  if (frame_.samples == 1) translucent_ |= stats.visibility == "layers";
  stats_.dropped += stats.triangles.dropped;
}

bool Picture::is_in_sight(const io::FileBox& box, std::size_t part, Rows rows) const {
  const raster::BoxPlace at = views_[part].place(box.min, box.max);
  return !at.outside && (!at.whole || (at.pixels.y1 > rows.begin && at.pixels.y0 < rows.end));
}

void Picture::sift(Rows rows) {
  const io::FileSelection small = selection_of(file_, marks_->list());
  const Scene scene = scene_of(file_, small, {});
  marks_->clear();
  Seen seen(*marks_, rows, &small);
  const std::uint64_t dropped = stats_.dropped;
  for (std::size_t part = 0; part < small.parts.size(); ++part) {
    const Mesh& mesh = scene.meshes[scene.instances[part].mesh];
    MeshView bare;
    bare.positions = mesh.view().positions;
    bare.indices = mesh.indices;
    survey(bare, part, small.parts[part].id, seen);
  }
  stats_.dropped = dropped;
}

bool Picture::keys_hide() const {
  // Some ways of blending let through what lies behind.
  const Transparency method = frame_.transparency.method;
  return frame_.samples == 1 && !translucent_ &&
         (method == Transparency::exact || method == Transparency::none);
}

std::vector<std::size_t> Picture::order() const {
  const std::vector<Chunks::Place>& places = chunks_->places();
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!keys_hide()) return order;
  // Keys are the greatest of all, marks are a set: no order changes a bit.
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
  const int y0 = std::max(place.pixels.y0, band_.begin), y1 = std::min(place.pixels.y1, band_.end);
  const ImageView<const std::uint64_t> nearest = keys();
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      if (!(highest < raster::depth_of_key(nearest(x, y)))) return false;
  return true;
}

bool Picture::find_by_chunks(Rows rows) {
  std::ranges::fill(keys_.pixels(), 0);
  marks_->clear();
  stats_.dropped = 0;
  std::uint64_t sifted = 0, looked_at = 0;
  std::uint64_t at_most = 0;  // are marked: who is that few need not be counted
  bool fits = true;
  chunks_->walk(
      order(),
      [&](const io::FileChunk& chunk, const Chunks::Place& at) {
        MeshView mesh;
        mesh.positions = chunk.positions;
        mesh.indices = chunk.indices;
        Seen seen(*marks_, rows);
        survey(mesh, at.part, chunk.first, seen);
        looked_at += chunk.count;
        tell("looking for what is seen", looked_at, file_.triangles());
        at_most += chunk.count;
        if (frame_.samples == 1 && !translucent_) return;
        // With several samples a mark is of a chunk's own winners.
        const auto is_to_sift = [&](std::uint64_t count) {
          return frame_.samples > 1 && bytes_of(count) <= budget_.triangles &&
                 (bytes_of(count - sifted) > budget_.triangles / 4 || !fits_at_once(count));
        };
        if (fits_at_once(at_most) && !is_to_sift(at_most)) return;
        std::uint64_t count = marks_->count();
        if (is_to_sift(count)) {
          sift(rows);
          count = sifted = marks_->count();
        }
        at_most = count;
        fits = fits_at_once(count);
        // As if the rest were like what has been looked at.
        seen_ = count / looked_at * file_.triangles() + count;
      },
      [&](const Chunks::Place& at) {
        if (!fits) return false;
        const std::optional<io::FileBox> box = chunks_->box(at);
        return !box || (is_in_sight(*box, at.part, rows) && !is_hidden(*box, at));
      });
  return fits;
}

bool Picture::find(Rows rows) {
  if (!keys_are_whole_) {
    if (!find_by_chunks(rows)) return false;
    keys_are_whole_ = frame_.samples == 1 && !translucent_;
  }
  if (frame_.samples == 1) {
    if (keys_are_whole_) marks_->clear();
    Seen seen(*marks_, rows);
    const ImageView<const std::uint64_t> nearest = keys();
    for (int y = rows.begin; y < rows.end; ++y)
      for (int x = 0; x < frame_.width; ++x)
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

// ---- the picture of what is marked

void Picture::draw(Rows rows) {
  const bool fits = find(rows);
  stats_.chunks = chunks_->read();
  stats_.skipped = chunks_->left_out();
  if (fits) return draw_marked(rows);
  std::uint64_t pieces = bytes_of(seen_) / budget_.triangles;
  if (options_.band_triangles != 0) pieces = std::max(pieces, seen_ / options_.band_triangles);
  split(rows, pieces * 5 / 4 + 2);
}

void Picture::split(Rows rows, std::uint64_t pieces) {
  // Parts of a picture consist of whole blocks, like planes of fragments; parts of a band consist
  // of whole bins.
  const int side = is_whole() ? raster::kBlockSize : raster::kBinSize;
  const int blocks = (rows.end - rows.begin + side - 1) / side;
  if (blocks < 2 || frame_.shader == Shader::depth) refuse_memory(bytes_of(seen_) * 2);
  const int n = static_cast<int>(std::min<std::uint64_t>(pieces, static_cast<unsigned>(blocks)));
  for (int i = 0; i < n; ++i) {
    const int begin = rows.begin + blocks * i / n * side;
    const int end = rows.begin + blocks * (i + 1) / n * side;
    draw({begin, std::min(end, rows.end)});
  }
}

void Picture::draw_marked(Rows rows) {
  tell("drawing what is seen", 0, 1);
  const io::FileSelection small = selection_of(file_, marks_->list());
  const Scene scene = scene_of(file_, small, options_.prepare);
  ++stats_.bands;
  stats_.seen += marks_->count();
  if (!is_whole()) {
    Targets part = targets_;
    ranks::each_target(part, [&](auto& view, std::uint32_t) {
      if (view.empty()) return;
      view.data = view.row(rows.begin - band_.begin);
      view.height = rows.end - rows.begin;
    });
    return draw_selection(scene, small, part, rows);
  }
  if (rows.begin == 0 && rows.end == frame_.height) {
    draw_selection(scene, small, targets_, rows);
    stats_.pixels_covered = stats_.frame.pixels_covered;
    return;
  }
  const std::uint32_t asked = ranks::targets_asked(targets_);
  const ranks::OwnImages images(asked, frame_.width, frame_.height);
  Targets own = images.targets();
  own.no_distance = targets_.no_distance;
  draw_selection(scene, small, own, rows);
  ranks::each_target(own, [&](const auto& from, std::uint32_t bit) {
    ranks::each_target(targets_, [&](const auto& to, std::uint32_t of_to) {
      if constexpr (std::is_same_v<decltype(from), decltype(to)>)
        if (bit == of_to && !from.empty())
          for (int y = rows.begin; y < rows.end; ++y)
            std::copy_n(from.row(y), from.width, to.row(y));
    });
  });
}

void Picture::draw_selection(const Scene& scene, const io::FileSelection& selection,
                             Targets targets, Rows rows) {
  const SceneBinding binding(scene);
  Image<std::int64_t> ids;
  // A primitive's number says what it is only together with its part's.
  if (!targets.primitives.empty() && targets.ids.empty() && selection.parts.size() > 1) {
    ids = Image<std::int64_t>(frame_.width, is_whole() ? frame_.height : rows.end - rows.begin);
    targets.ids = ids;
  }
  if (is_whole()) {
    stats_.frame = renderer_->render(binding.view(), camera_, frame_, targets);
  } else {
    draw_part(binding.view(), rows, targets);
    stats_.pixels_covered += stats_.frame.pixels_covered;
    targets = ranks::in_place(targets, rows.begin);
  }
  for (int y = rows.begin; y < rows.end; ++y) {
    if (!targets.primitives.empty())
      for (int x = 0; x < frame_.width; ++x)
        if (std::int64_t& primitive = targets.primitives(x, y); primitive >= 0) {
          const auto id =
              static_cast<std::uint64_t>(targets.ids.empty() ? primitive : targets.ids(x, y));
          const auto at =
              std::ranges::upper_bound(selection.parts, id, {}, &io::FileSelection::Part::id);
          primitive = static_cast<std::int64_t>(selection.original(id) - std::prev(at)->first);
        }
    if (!targets.ids.empty())
      for (int x = 0; x < frame_.width; ++x)
        if (std::int64_t& id = targets.ids(x, y); id >= 0)
          id = static_cast<std::int64_t>(selection.original(static_cast<std::uint64_t>(id)));
  }
}

void Picture::draw_part(const SceneView& scene, Rows rows, const Targets& asked) {
  FrameOptions held = frame_, untoned = frame_;
  held.height = rows.end - rows.begin;
  untoned.tone = {};
  TonePass tone;
  const bool tones = TonePass::wanted(frame_, asked, frame_.shader);
  const Targets filled = tones ? tone.targets(held, asked) : asked;
  Targets targets = ranks::in_place(filled, rows.begin);
  targets.depth = filled.depth;  // these two have only the rows of the part
  targets.ids = filled.ids;
  stats_.frame =
      RendererAccess::render(*renderer_, scene, camera_, untoned, targets, {.part = rect_of(rows)});
  if (tones) tone.draw(held, asked, RendererAccess::threads(*renderer_));
}

}  // namespace rastrum::out_of_core
