// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/out_of_core.hpp>

#include <filesystem>
#include <system_error>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/no_memory.hpp>
#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/large_file.hpp>
#include <rastrum/out_of_core/picture.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/stop.hpp>

namespace rastrum {
namespace {

/// Returns f(), as in_memory does. If f throws and the file is small, throws the ordinary reader's
/// error if there is one: then drawing in core would not help either.
template <class F>
auto as_the_reader(const std::filesystem::path& file, const F& f) {
  constexpr std::uintmax_t kSmall = std::uintmax_t{16} << 20;
  try {
    return in_memory(f);
  } catch (const Error& e) {
    std::error_code ignored;
    if ((e.code() == Errc::bad_format || e.code() == Errc::unsupported) &&
        std::filesystem::file_size(file, ignored) <= kSmall)
      (void)io::read_scene(file);
    throw;
  }
}

}  // namespace

OutOfCoreFile::OutOfCoreFile(PathView file, std::uint64_t memory_limit)
    : file_("OutOfCoreFile", as_the_reader(file.text(), [&] {
              return io::LargeFile::open(file.text(), memory_limit);
            })) {}
OutOfCoreFile::~OutOfCoreFile() = default;
OutOfCoreFile::OutOfCoreFile(OutOfCoreFile&&) noexcept = default;
OutOfCoreFile& OutOfCoreFile::operator=(OutOfCoreFile&&) noexcept = default;

std::uint64_t OutOfCoreFile::triangles() const {
  return file_->triangles();
}
std::uint64_t OutOfCoreFile::vertices() const {
  return file_->vertices();
}
bool OutOfCoreFile::has_normals() const {
  return file_->has_normals();
}
bool OutOfCoreFile::has_materials() const {
  return file_->has_materials();
}
std::uint64_t OutOfCoreFile::bytes_in_memory() const {
  return file_->bytes_in_memory();
}

Scene OutOfCoreFile::sample(FunctionRef<void(Scene&)> prepare) const {
  const FloatScope floats;
  return as_the_reader(file_->name(), [&] {
    return out_of_core::scene_of(*file_, out_of_core::selection_of(*file_, {}), prepare);
  });
}

OutOfCoreStats OutOfCoreFile::render(const Camera& camera, const FrameOptions& frame,
                                     const Targets& targets, const OutOfCoreOptions& options,
                                     StopToken stop) const {
  const FloatScope floats;
  const StopScope scope(stop);
  return as_the_reader(file_->name(), [&] {
    return out_of_core::Picture(*file_, camera, frame, targets, options).draw();
  });
}

/// The vertices of a file in runs, which threads read.
class FitOfFile::Vertices final : public FitVertices {
 public:
  /// `sample`: a scene with an instance for each part of the file.
  Vertices(const io::LargeFile& file, const Scene& sample, int threads)
      : file_(file), threads_(threads) {
    for (const Instance& instance : sample.instances)
      object_to_world_.push_back(instance.object_to_world);
  }
  [[nodiscard]] std::size_t runs() const override {
    return as_the_reader(file_.name(), [&] { return file_.position_runs(threads_); });
  }
  [[nodiscard]] const Mat4d& object_to_world(std::size_t run) const override {
    return object_to_world_[file_.part_of_run(run)];
  }
  [[nodiscard]] std::optional<Box> box(std::size_t run) const override {
    const std::optional<io::FileBox> box = file_.run_box(run);
    if (!box) return {};
    return Box{Vec3d(box->min), Vec3d(box->max)};
  }
  void read(std::span<const std::size_t> runs,
            FunctionRef<void(std::size_t i, std::span<const Vec3d> vertices)> f) const override {
    file_.read_positions(threads_, runs, f);
  }

 private:
  const io::LargeFile& file_;
  std::vector<Mat4d> object_to_world_;  ///< by part
  mutable parallel::Threads threads_;
};

FitOfFile::FitOfFile(const OutOfCoreFile& file, FunctionRef<void(Scene&)> prepare, int threads)
    : vertices_(in_memory([&] {
        return std::make_unique<const Vertices>(*file.file_, file.sample(prepare), threads);
      })) {}
FitOfFile::~FitOfFile() = default;

const FitVertices* FitOfFile::beyond() const {
  return vertices_.get();
}

}  // namespace rastrum
