# CUDA, where it was asked for: RASTRUM_CUDA_FOUND says so. Nothing of the CPU build needs it; the
# translation units under tests/cuda keep the shared code compilable for the device.
set(RASTRUM_CUDA_FOUND OFF)
if(RASTRUM_CUDA)
  include(CheckLanguage)
  check_language(CUDA)
  if(NOT CMAKE_CUDA_COMPILER)
    message(FATAL_ERROR "RASTRUM_CUDA is ON, and no CUDA compiler was found: put nvcc on the PATH, "
      "or set CMAKE_CUDA_COMPILER")
  endif()
  # Machine code of the A100 and the H100, and PTX for what comes after them.
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    set(CMAKE_CUDA_ARCHITECTURES 80-real 90)
  endif()
  enable_language(CUDA)
  # CMake 3.25.1 does not know yet that nvcc has C++20.
  if(NOT DEFINED CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
    set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
  endif()
  set(cuda_flags --fmad=false --expt-relaxed-constexpr -Xcompiler=-ffp-contract=off
    -Werror=all-warnings)
  target_compile_options(rastrum_flags INTERFACE "$<$<COMPILE_LANGUAGE:CUDA>:${cuda_flags}>")
  set(RASTRUM_CUDA_FOUND ON)
endif()

# Thrust's headers also serve a plain C++ compiler: tests run the device's code on the CPU, with any
# compiler and its sanitizers, wherever a toolkit lies.
find_package(CUDAToolkit QUIET)
find_path(RASTRUM_CCCL_INCLUDE_DIR cuda/std/version
  HINTS ${CUDAToolkit_INCLUDE_DIRS} /usr/local/cuda/include PATH_SUFFIXES cccl
  DOC "The folder of thrust/, cub/ and cuda/")
