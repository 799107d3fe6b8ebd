# Run by ctest: compiles SOURCE with COMPILER, FLAGS and all warnings as errors. MESSAGE is empty, and
# nothing may be said, or it is what the one error says.
list(TRANSFORM INCLUDES PREPEND -I)
execute_process(
  COMMAND ${COMPILER} -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Werror ${FLAGS} ${INCLUDES} ${SOURCE}
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)

if(MESSAGE STREQUAL "")
  if(NOT code EQUAL 0 OR NOT output STREQUAL "")
    message(FATAL_ERROR "${COMPILER} says of ${SOURCE}:\n${output}")
  endif()
  return()
endif()
string(REGEX MATCHALL "error: " errors "${output}")
list(LENGTH errors count)
string(FIND "${output}" "${MESSAGE}" at)
if(at EQUAL -1 OR NOT count EQUAL 1)
  message(FATAL_ERROR "${COMPILER} does not say '${MESSAGE}', or ${count} errors:\n${output}")
endif()
