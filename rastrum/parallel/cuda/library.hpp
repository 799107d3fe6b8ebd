// SPDX-License-Identifier: BSD-3-Clause
// The library of device code, librastrum_cuda.so: all that nvcc compiles of Rastrum, in a file of
// its own that is opened when somebody asks for a CUDA device. So nobody else carries it, needs a
// toolkit to link, or notices that there is none. Decision 0026.
//
// Each floor has a table of what it asks of a device; their types are the floors' own. The library
// has a copy of what it calls of Rastrum::rastrum, to itself: what it is to share with its caller
// (memory accounts, threads, the token that stops a frame) is passed.
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

/// A table of code that Rastrum does not know, which is compiled into the library beside it: a
/// static object adds itself, its user finds it by its name and knows its type.
class AddedTable {
 public:
  AddedTable(const char* name, const void* table) : name_(name), table_(table), next_(first()) {
    first() = this;
  }
  AddedTable(const AddedTable&) = delete;
  AddedTable& operator=(const AddedTable&) = delete;

  /// The last one that was added.
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
  /// The program's own (RASTRUM_CUDA_LIBRARY_VERSION, which changes with every header), or nothing
  /// else here may be read. First, in all versions.
  const char* version;
  CudaStatus (*status)();  ///< what cuda_status() says
  const CudaRendering* rendering;
  const terrain::CudaTerrain* terrain;
  const AddedTable* added;  ///< the first one
};

/// The file, which the dynamic loader looks for by its own rules: in the program's RUNPATH, in
/// LD_LIBRARY_PATH, and where it looks for all libraries. A program that links Rastrum's CMake
/// targets has the right RUNPATH.
inline constexpr const char* kCudaLibraryFile = "librastrum_cuda.so";
/// The function that the file exports: `const CudaLibrary* rastrum_cuda_library()`.
inline constexpr const char* kCudaLibrarySymbol = "rastrum_cuda_library";

/// A library, or why there is none, as the end of a sentence.
struct OpenedCudaLibrary {
  const CudaLibrary* library = nullptr;
  std::string why_not;
};
/// Opens a file of that name; it stays open. Refuses one of another version.
[[nodiscard]] OpenedCudaLibrary open_cuda_library(const char* file);

/// kCudaLibraryFile, opened by the first call, from any thread. Throws Error{no_device} where there
/// is none; choose_device has said so before.
[[nodiscard]] const CudaLibrary& cuda_library();

/// The table of that name in the library; throws Error{no_device} where it has none.
[[nodiscard]] const void* added_table(const CudaLibrary& library, std::string_view name);

/// Takes `library` in the place of the file, before anybody asked for it: for a program that links
/// the code of devices, such as tests that have it compiled for the CPU.
void set_cuda_library(const CudaLibrary& library);

}  // namespace rastrum::parallel

/// Defined in the library of device code (rastrum/cuda/library.cpp).
extern "C" const rastrum::parallel::CudaLibrary* rastrum_cuda_library() noexcept;
