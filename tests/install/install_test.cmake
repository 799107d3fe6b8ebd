# Run by ctest: install, look at what is there, build examples/ against it, run one of them.
file(REMOVE_RECURSE ${WORK_DIR})
set(prefix ${WORK_DIR}/prefix)
set(examples ${WORK_DIR}/examples)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nended with ${code}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
if(EXISTS ${BUILD_DIR}/apps/rastrum/rastrum)
  run(${prefix}/bin/rastrum --version)
  if(NOT output MATCHES "${VERSION}")
    message(FATAL_ERROR "the installed program says '${output}', not version ${VERSION}")
  endif()
endif()

# Copied away from the source tree, so that no header can be found beside them.
file(COPY ${SOURCE_DIR}/examples DESTINATION ${WORK_DIR}/source)
run(${CMAKE_COMMAND} -S ${WORK_DIR}/source/examples -B ${examples} -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${examples})

file(STRINGS ${examples}/CMakeCache.txt found REGEX "^Rastrum_DIR:")
if(NOT found MATCHES "${prefix}")
  message(FATAL_ERROR "the examples were built against another Rastrum: ${found}")
endif()

run(${examples}/fit_camera)
if(NOT output MATCHES "eye 0 0 3.4641")
  message(FATAL_ERROR "fit_camera printed:\n${output}")
endif()
