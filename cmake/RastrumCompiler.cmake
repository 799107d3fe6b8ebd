# Flags that every target of the project shares. The arithmetic ones are part of the picture rules:
# multiply and add stay apart, so that every machine gives the same bits.
add_library(rastrum_flags INTERFACE)
target_compile_options(rastrum_flags INTERFACE
  -ffp-contract=off -fno-math-errno
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wnon-virtual-dtor)
if(RASTRUM_WERROR)
  target_compile_options(rastrum_flags INTERFACE -Werror)
endif()
if(RASTRUM_SANITIZE)
  target_compile_options(rastrum_flags INTERFACE
    -fsanitize=${RASTRUM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(rastrum_flags INTERFACE -fsanitize=${RASTRUM_SANITIZE})
endif()
