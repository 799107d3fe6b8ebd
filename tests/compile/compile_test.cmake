# Run by ctest: compiles SOURCE with COMPILER, FLAGS and all warnings as errors. If MESSAGE is empty there
# must be no message, else one error with that text.
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
