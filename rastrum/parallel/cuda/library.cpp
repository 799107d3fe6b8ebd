// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/parallel/cuda/library.hpp>

#if !defined(_WIN32)
#include <dlfcn.h>
#endif

#include <rastrum/core/number_text.hpp>
#include <rastrum/error.hpp>

namespace rastrum::parallel {
namespace {

/// Replaces the file (set_cuda_library).
const CudaLibrary* in_its_place = nullptr;

const OpenedCudaLibrary& opened() {
  static const OpenedCudaLibrary once = in_its_place != nullptr
                                            ? OpenedCudaLibrary{in_its_place, {}}
                                            : open_cuda_library(kCudaLibraryFile);
  return once;
}

}  // namespace

#if defined(_WIN32)
OpenedCudaLibrary open_cuda_library(const char* /*file*/) {
  return {nullptr, "Rastrum has no device code for Windows"};
}
#else
OpenedCudaLibrary open_cuda_library(const char* file) {
  // Its names stay local (RTLD_LOCAL), and all are resolved now (RTLD_NOW).
  void* const handle = ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr)
    return {nullptr, text_of("the library of device code cannot be opened: ", ::dlerror(),
                             "; it is built with -DRASTRUM_CUDA=ON (nvcc 12.4 or newer), and "
                             "LD_LIBRARY_PATH may name its folder")};
  const auto table =
      reinterpret_cast<decltype(&rastrum_cuda_library)>(::dlsym(handle, kCudaLibrarySymbol));
  if (table == nullptr)
    return {nullptr, std::string(file).append(" is no library of Rastrum's device code")};
  const CudaLibrary* const library = table();
  if (std::string_view(library->version) != RASTRUM_CUDA_LIBRARY_VERSION)
    return {nullptr, text_of("the library of device code, ", file, ", belongs to Rastrum ",
                             library->version, ", but this program to ",
                             RASTRUM_CUDA_LIBRARY_VERSION, "; install both from one build")};
  return {library, {}};
}
#endif

const CudaLibrary& cuda_library() {
  const OpenedCudaLibrary& there = opened();
  if (there.library == nullptr) throw Error(Errc::no_device, "CUDA: " + there.why_not);
  return *there.library;
}

const void* added_table(const CudaLibrary& library, std::string_view name) {
  for (const AddedTable* added = library.added; added != nullptr; added = added->next_)
    if (added->name_ == name) return added->table_;
  throw Error(Errc::no_device,
              std::string("CUDA: the library of device code is built without ").append(name));
}

void set_cuda_library(const CudaLibrary& library) {
  in_its_place = &library;
}

CudaStatus cuda_status() {
  const OpenedCudaLibrary& there = opened();
  if (there.library != nullptr) return there.library->status();
  CudaStatus status;
  status.why_not = there.why_not;
  return status;
}

}  // namespace rastrum::parallel
