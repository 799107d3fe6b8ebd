# Flags that every target of the project shares. The arithmetic ones are part of the picture rules:
# multiply and add stay apart, so that every machine gives the same bits.
add_library(rastrum_flags INTERFACE)

set(cxx_flags -ffp-contract=off -fno-math-errno
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wnon-virtual-dtor)
if(RASTRUM_WERROR)
  list(APPEND cxx_flags -Werror)
endif()
target_compile_options(rastrum_flags INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:${cxx_flags}>")

if(RASTRUM_SANITIZE)
  set(sanitizer_flags
    -fsanitize=${RASTRUM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(RASTRUM_SANITIZE MATCHES "address,undefined")
    # The address sanitizer sees what these would, where it is read or written; they are half of the code.
    list(APPEND sanitizer_flags -fno-sanitize=null,object-size,vptr,pointer-overflow)
  endif()
  target_compile_options(rastrum_flags INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:${sanitizer_flags}>")
  target_link_options(rastrum_flags INTERFACE -fsanitize=${RASTRUM_SANITIZE})
  # Kernels of three instruction sets are a third of what compiling costs (simd_targets.hpp).
  target_compile_definitions(rastrum_flags INTERFACE RASTRUM_ONE_SIMD_TARGET)
endif()
