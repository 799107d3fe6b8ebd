# What zig.cmake adds for WebAssembly. zig's own C++ library has neither exceptions nor threads there, so
# CMakeLists.txt compiles it from the same sources, as libcxx.h says.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
# Exceptions have the form of the standard, which Chromium knows since 137, Firefox since 131, Safari since 18.4. The
# readers of PNG and JPEG leave by longjmp.
set(flags "-mcpu=generic+exception_handling+simd128 -fwasm-exceptions -mllvm -wasm-use-legacy-eh=false")
string(APPEND flags " -mllvm -wasm-enable-sjlj -D_WASI_EMULATED_MMAN -D_WASI_EMULATED_GETPID -D_WASI_EMULATED_SIGNAL")
set(CMAKE_C_FLAGS_INIT "${flags}")
get_filename_component(RASTRUM_ZIG_LIB ${RASTRUM_ZIG} DIRECTORY)
string(APPEND RASTRUM_ZIG_LIB /lib)
set(CMAKE_CXX_FLAGS_INIT "${flags} -nostdinc++ -include ${CMAKE_CURRENT_LIST_DIR}/libcxx.h \
-I${RASTRUM_ZIG_LIB}/libcxx/include -I${RASTRUM_ZIG_LIB}/libcxxabi/include")
# FindThreads cannot try to link, and there is no library of threads.
set(CMAKE_HAVE_LIBC_PTHREAD ON CACHE BOOL "")
set(THREADS_PREFER_PTHREAD_FLAG OFF)
