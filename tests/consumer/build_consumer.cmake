# Configures and builds the project beside this file in WORK_DIR, with hsdm found by WAY, and runs it if installed.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

file(REMOVE_RECURSE ${WORK_DIR})
if(WAY STREQUAL "find_package")
  run(${CMAKE_COMMAND} --install ${HSDM_BINARY_DIR} --prefix ${WORK_DIR}/prefix)
endif()
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/project -B ${WORK_DIR}/build -G ${GENERATOR}
  -D CMAKE_BUILD_TYPE=None -D CMAKE_CXX_FLAGS=-O0 -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix
  -D WAY=${WAY} -D HSDM_SOURCE_DIR=${HSDM_SOURCE_DIR})
if(WAY STREQUAL "find_package")
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
  run(${WORK_DIR}/build/consumer)
else()
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/build --target consumer_objects)
endif()
