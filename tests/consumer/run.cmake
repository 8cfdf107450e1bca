cmake_minimum_required(VERSION 3.25) # a script has no policies otherwise

# run(COMMAND...): fails with what the command printed if it fails; that is in `output` afterwards.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# take_objects(OTHER-TREE TREE): what is configured from now on in TREE takes objects from OTHER-TREE where it has them.
macro(take_objects other tree)
  set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} "sh;${CMAKE_CURRENT_LIST_DIR}/take_object.sh;${other};${tree}")
endmacro()

# configure(FOLDER TREE TYPE FLAGS ARGUMENT...): with hsdm in WORK_DIR/prefix, if it is installed. (CMake looks into lib64 of a
# prefix on some systems only.)
function(configure folder tree type flags)
  set(package)
  if(LIBDIR STREQUAL "lib64")
    set(package -D hsdm_DIR=${WORK_DIR}/prefix/lib64/cmake/hsdm)
  endif()
  run(${CMAKE_COMMAND} -S ${folder} -B ${tree} -G ${GENERATOR} -D CMAKE_BUILD_TYPE=${type} -D CMAKE_CXX_FLAGS=${flags}
    -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix -D HSDM_SOURCE_DIR=${HSDM_SOURCE_DIR}
    ${package} ${ARGN})
  set(output "${output}" PARENT_SCOPE)
endfunction()

# link_by_pkg_config(OPTION...): the program of WORK_DIR/build linked once more and run, by the flags of hsdm.pc, which find a
# header too; options are pkg-config's.
function(link_by_pkg_config)
  find_program(PKG_CONFIG pkg-config REQUIRED)
  set(ENV{PKG_CONFIG_PATH} ${WORK_DIR}/prefix/${LIBDIR}/pkgconfig)
  run(${PKG_CONFIG} --cflags --libs ${ARGN} hsdm)
  separate_arguments(flags UNIX_COMMAND "${output}")
  file(WRITE ${WORK_DIR}/by_pkg_config.cc "#include <hsdm/version.hh>\n")
  file(GLOB_RECURSE object ${WORK_DIR}/build/main.cc.o)
  run(${CXX} ${WORK_DIR}/by_pkg_config.cc ${object} ${flags} -Wl,-rpath,${WORK_DIR}/prefix/${LIBDIR}
    -o ${WORK_DIR}/by_pkg_config)
  run(${WORK_DIR}/by_pkg_config)
endfunction()

# run_template(): the installed template of a module, copied, built as it comes and run by the installed command, in a folder that
# nobody else can write to, as hsdm wants modules to be. It is built without NDEBUG, unlike hsdm.
function(run_template)
  execute_process(COMMAND mktemp -d OUTPUT_VARIABLE folder OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  file(COPY ${WORK_DIR}/prefix/${DOCDIR}/examples/template DESTINATION ${folder})
  configure(${folder}/template ${folder}/build "" "-O0 -Wall -Wextra -Wshadow -Wconversion -Werror")
  run(${CMAKE_COMMAND} --build ${folder}/build)
  run(chmod go-w ${folder}/build/offset.so)
  run(${CMAKE_CTEST_COMMAND} --test-dir ${folder}/build --output-on-failure --no-tests=error)
  run(nm -D --defined-only -C ${folder}/build/offset.so)
  string(REGEX MATCHALL "[0-9a-f]+ [A-Z] [^\n]+" exported "${output}")
  list(LENGTH exported count)
  if(NOT count EQUAL 1)
    message(FATAL_ERROR "the module exports more than hsdm_plugin:\n${output}")
  endif()
  file(REMOVE_RECURSE ${folder})
endfunction()
