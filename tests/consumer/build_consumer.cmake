# Configures and builds the project beside this file in WORK_DIR, with hsdm found by WAY, and runs it if installed.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

function(configure type flags)
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/project -B ${WORK_DIR}/build -G ${GENERATOR}
    -D CMAKE_BUILD_TYPE=${type} -D CMAKE_CXX_FLAGS=${flags} -D CMAKE_CXX_COMPILER=${CXX}
    -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix -D WAY=${WAY} -D HSDM_SOURCE_DIR=${HSDM_SOURCE_DIR})
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(build_installed)
  run(${CMAKE_COMMAND} --install ${HSDM_BINARY_DIR} --prefix ${WORK_DIR}/prefix)
  configure(None -O0)
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
  run(${WORK_DIR}/build/consumer)
endfunction()

function(build_in_tree)
  configure("" "")
  if(NOT output MATCHES "hsdm is compiled")
    message(FATAL_ERROR "no warning where nothing asks for optimisation:\n${output}")
  endif()
  configure("" -O0)
  if(output MATCHES "hsdm is compiled")
    message(FATAL_ERROR "a warning though the parent chose its flags:\n${output}")
  endif()
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/build --target consumer_objects)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
if(WAY STREQUAL "find_package")
  build_installed()
else()
  build_in_tree()
endif()
