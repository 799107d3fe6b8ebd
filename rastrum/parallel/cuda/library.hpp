// SPDX-License-Identifier: BSD-3-Clause
// The library of device code, librastrum_cuda.so: all of Rastrum that nvcc compiles. It is opened
// when a CUDA device is asked for, so programs without CUDA neither carry it nor need a toolkit to
// link. Decision 0026.
//
// Each floor of Rastrum (docs/architecture.md) has a table of what it calls on a device, of its own
// type. The library has its own copy of the code of Rastrum::rastrum that it calls, so shared state
// (memory accounts, threads, the stop token) is passed in.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <rastrum/parallel/cuda/status.hpp>

namespace rastrum {
struct CudaRendering;  // render/cuda/rasterizer.hpp
namespace terrain {
struct CudaTerrain;  // terrain/cuda/device.hpp
}
}  // namespace rastrum

namespace rastrum::parallel {

struct CudaLibrary;

/// A table of code that is compiled into the library but unknown to Rastrum. A static object
/// registers itself; its user finds it by name and knows its type.
class AddedTable {
 public:
  AddedTable(const char* name, const void* table) : name_(name), table_(table), next_(first()) {
    first() = this;
  }
  AddedTable(const AddedTable&) = delete;
  AddedTable& operator=(const AddedTable&) = delete;

  /// The one added last.
  static const AddedTable*& first() {
    static const AddedTable* first = nullptr;
    return first;
  }

 private:
  friend const void* added_table(const CudaLibrary& library, std::string_view name);

  const char* name_;
  const void* table_;
  const AddedTable* next_;
};

struct CudaLibrary {
  /// Must equal the program's RASTRUM_CUDA_LIBRARY_VERSION, which changes with every header;
  /// otherwise nothing else here may be read. Comes first in all versions.
  const char* version;
  CudaStatus (*status)();  ///< what cuda_status() returns
  const CudaRendering* rendering;
  const terrain::CudaTerrain* terrain;
  const AddedTable* added;  ///< the first one
};

/// The dynamic loader finds the file by its rules: RUNPATH, LD_LIBRARY_PATH, system folders.
/// Programs that link Rastrum's CMake targets have the right RUNPATH.
inline constexpr const char* kCudaLibraryFile = "librastrum_cuda.so";
/// The function that the file exports: `const CudaLibrary* rastrum_cuda_library()`.
inline constexpr const char* kCudaLibrarySymbol = "rastrum_cuda_library";

/// A library, or as the end of a sentence why there is none.
struct OpenedCudaLibrary {
  const CudaLibrary* library = nullptr;
  std::string why_not;
};
/// Opens a file of that name, for good. Refuses one of another version.
[[nodiscard]] OpenedCudaLibrary open_cuda_library(const char* file);

/// kCudaLibraryFile, opened by the first call; thread-safe. Throws Error{no_device} if there is
/// none, which choose_device reports beforehand.
[[nodiscard]] const CudaLibrary& cuda_library();

/// The library's table of that name; throws Error{no_device} if it has none.
[[nodiscard]] const void* added_table(const CudaLibrary& library, std::string_view name);

/// Uses `library` instead of the file; call it before anything asks for one. For programs that link
/// device code, such as tests on the CPU.
void set_cuda_library(const CudaLibrary& library);

}  // namespace rastrum::parallel

/// Defined in the library of device code (rastrum/cuda/library.cpp).
extern "C" const rastrum::parallel::CudaLibrary* rastrum_cuda_library() noexcept;
