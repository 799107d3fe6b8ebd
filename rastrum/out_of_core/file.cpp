#include <rastrum/out_of_core.hpp>

#include <rastrum/io.hpp>
#include <rastrum/io/large_file.hpp>
#include <rastrum/out_of_core/picture.hpp>
#include <rastrum/stop.hpp>

namespace rastrum {

OutOfCoreFile::OutOfCoreFile(const std::filesystem::path& file)
    : file_(io::LargeFile::open(file)) {}
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

Scene OutOfCoreFile::sample(const std::function<void(Scene&)>& prepare) const {
  return out_of_core::scene_of(*file_, std::vector<std::uint64_t>{0}, prepare);
}

OutOfCoreStats OutOfCoreFile::render(const Camera& camera, const FrameOptions& frame,
                                     const Targets& targets, const OutOfCoreOptions& options,
                                     std::stop_token stop) const {
  const parallel::StopScope scope(stop);
  return out_of_core::Picture(*file_, camera, frame, targets, options).draw();
}

void FitOfFile::for_each_run(const std::function<void(std::span<const Vec3d>)>& f) const {
  file_.file_->for_each_position_in_use(f);
}

}  // namespace rastrum
