# Builds what `bootstrap.sh demo` does in WORK_DIR, with a shared library, installs that, and starts the command when the build
# tree is gone; then a consumer against that. Objects are those of the tree that is tested, and the consumer's those of the test of the
# static library, where they are: what remains is linking.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

file(STRINGS ${HSDM_SOURCE_DIR}/cmake/bootstrap.sh targets REGEX "cmake --build build/release --target")
string(REGEX REPLACE ".*--target " "" targets "${targets}")
separate_arguments(targets)
list(REMOVE_ITEM targets hsdm_generate) # of the tests, and not installed

file(REMOVE_RECURSE ${WORK_DIR})
take_objects(${HSDM_BINARY_DIR} ${WORK_DIR}/build)
run(${CMAKE_COMMAND} -S ${HSDM_SOURCE_DIR} -B ${WORK_DIR}/build -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
  -D CMAKE_BUILD_TYPE=None -D CMAKE_INSTALL_LIBDIR=${LIBDIR} -D BUILD_SHARED_LIBS=ON -D HSDM_BUILD_TESTS=OFF
  -D HSDM_UNITY=${HSDM_UNITY})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build --target ${targets})
run(${CMAKE_COMMAND} --install ${WORK_DIR}/build --prefix ${WORK_DIR}/prefix)
file(REMOVE_RECURSE ${WORK_DIR}/build)

if(NOT EXISTS ${WORK_DIR}/prefix/${LIBDIR}/libhsdm.so.${SOVERSION})
  message(FATAL_ERROR "no libhsdm.so.${SOVERSION}")
endif()
run(${WORK_DIR}/prefix/bin/hsdm --version)
file(GLOB modules ${WORK_DIR}/prefix/${LIBDIR}/hsdm/plugins/*.so)
file(GET_RUNTIME_DEPENDENCIES MODULES ${modules} RESOLVED_DEPENDENCIES_VAR found) # fails if they do not find one

# Of what is compiled into the library nothing else is exported.
run(nm -D --defined-only ${WORK_DIR}/prefix/${LIBDIR}/libhsdm.so)
string(REGEX MATCHALL "[0-9a-f]+ [A-Z] [^\n]+" exported "${output}")
list(FILTER exported EXCLUDE REGEX "4hsdm")
if(exported)
  message(FATAL_ERROR "exported beside the project's own:\n${exported}")
endif()

take_objects(${STATIC_DIR} ${WORK_DIR})
configure(${CMAKE_CURRENT_LIST_DIR}/project ${WORK_DIR}/build None -O0 -D WAY=find_package)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/consumer)
link_by_pkg_config()
run_template()
