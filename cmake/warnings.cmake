# hsdm_warnings(TARGET): the warnings every target of the project is clean of.
# Kept PRIVATE, so that a consumer's own flags are untouched.
function(hsdm_warnings target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wshadow -Wconversion
    $<$<BOOL:${HSDM_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()

# hsdm_includes_openmesh_kernel(SOURCE...): g++ 12 reports -Wmaybe-uninitialized from inside OpenMesh's
# own headers; that one warning is switched off for the files that include a mesh kernel, nothing else. A file with
# options of its own is compiled alone, so with HSDM_UNITY it is switched off for all of the library and the tests.
# A property of a source file holds in one folder only: it is set where the target that compiles it lives.
function(hsdm_includes_openmesh_kernel)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    return()
  endif()
  if(HSDM_UNITY)
    foreach(target hsdm hsdm_tests)
      if(TARGET ${target})
        target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
      endif()
    endforeach()
    return()
  endif()
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE sources)
  set_property(SOURCE ${sources} APPEND PROPERTY COMPILE_OPTIONS -Wno-maybe-uninitialized)
  foreach(target hsdm hsdm_tests)
    if(TARGET ${target})
      set_property(SOURCE ${sources} TARGET_DIRECTORY ${target}
                   APPEND PROPERTY COMPILE_OPTIONS -Wno-maybe-uninitialized)
    endif()
  endforeach()
endfunction()

# hsdm_hardly_optimised(TARGET): for what spends its time in the library and is used. It compiles in two thirds of the time
# then.
function(hsdm_hardly_optimised target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU") # g++ 12 warns of std::string itself then
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Wno-array-bounds;-Wno-stringop-overflow>)
  endif()
endfunction()

# hsdm_unoptimised(TARGET...): tests, which spend their time in the library, take half of the time to compile then. A static
# library comes first when they are linked, for the linker takes the first copy of an inline function it finds.
function(hsdm_unoptimised)
  get_target_property(type hsdm TYPE)
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE -O0)
    if(type STREQUAL "STATIC_LIBRARY")
      target_link_options(${target} PRIVATE LINKER:--whole-archive $<TARGET_FILE:hsdm> LINKER:--no-whole-archive)
    endif()
  endforeach()
endfunction()

# hsdm_unoptimised_with_sanitizers(TARGET...): what is used without them. It takes a third of the time to compile.
function(hsdm_unoptimised_with_sanitizers)
  if(HSDM_SANITIZE)
    hsdm_unoptimised(${ARGN})
  endif()
endfunction()

# hsdm_sanitize(LIBRARY): builds the library, and all that links it, with the sanitizers of HSDM_SANITIZE (a
# list for -fsanitize=, e.g. "address,undefined"; empty: none). For the project's own test builds.
set(HSDM_SANITIZE "" CACHE STRING "Sanitizers to build with")
function(hsdm_sanitize library)
  if(NOT HSDM_SANITIZE)
    return()
  endif()
  # What the address sanitizer tells as well is told once: it is half of what undefined takes to compile. A pointer that
  # wraps round is told of where it is read or written.
  target_compile_options(${library} PUBLIC
    -fsanitize=${HSDM_SANITIZE} -fno-sanitize=null,object-size,pointer-overflow,vptr -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(${library} PUBLIC -fsanitize=${HSDM_SANITIZE})
  if(HSDM_SANITIZE STREQUAL "thread")
    # The installed TBB is not built for the thread sanitizer: see tests/tsan/tbb/stand_in.h.
    target_include_directories(${library} BEFORE PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/tests/tsan>)
  endif()
endfunction()

# hsdm_count_lines(LIBRARY): with HSDM_COVERAGE, counts which of its lines and branches run (cmake/coverage.sh).
option(HSDM_COVERAGE "Count which lines and branches of the library run (clang++ only)" OFF)
function(hsdm_count_lines library)
  if(HSDM_COVERAGE)
    target_compile_options(${library} PRIVATE -fprofile-instr-generate -fcoverage-mapping)
    target_link_options(${library} PUBLIC -fprofile-instr-generate)
  endif()
endfunction()

# hsdm_instrument_for_fuzzers(LIBRARY): counts which of its branches run, by which fuzzers find new inputs. Other
# programs that link the library are not changed: the sanitizers' runtime has what the counters call. What is compared
# with what tells a fuzzer words of a format, but nothing in geometry, where recording it takes most of the time.
function(hsdm_instrument_for_fuzzers library)
  if(HSDM_BUILD_FUZZERS)
    target_compile_options(${library} PRIVATE -fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp)
  endif()
endfunction()

# hsdm_trace_comparisons(SOURCE...): what the current folder's sources compare is recorded after all, unless they are
# compiled together: a file with options of its own would be compiled alone, in three times the time.
function(hsdm_trace_comparisons)
  if(HSDM_BUILD_FUZZERS AND NOT HSDM_UNITY)
    list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE sources)
    set_property(SOURCE ${sources} TARGET_DIRECTORY hsdm
                 APPEND PROPERTY COMPILE_OPTIONS -fsanitize-coverage=trace-cmp)
  endif()
endfunction()
