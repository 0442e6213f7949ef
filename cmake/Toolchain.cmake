# Compiler and linker settings for everything that is ours. Warnings are errors; a sanitizer covers the whole build.
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "" FORCE)
endif()
# Line tables are enough for back traces and keep the build small and fast.
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g1")
set(CMAKE_C_FLAGS_RELWITHDEBINFO "-O2 -g1")
if(CELLMIRROR_SANITIZE)  # for finding mistakes, not for speed: builds in two thirds of the time
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
  set(CMAKE_C_FLAGS_RELWITHDEBINFO "-O1 -g1")
endif()
# How a test is compiled decides nothing: fast to build is what counts, measured as CPU time of a typical source: g++ -O2 5.6 s,
# -O1 4.6 s; clang with sanitizers -O1 8.5 s, -O0 4.4 s, and 3.3 s without the fuzzer's counters, which no fuzz target sees. Without line tables a tenth to a fifth less: a
# test tells its lines itself, and back traces show those of the libraries.
# With sanitizers the libraries that read and write are not optimised either (CELLMIRROR_READS_AND_WRITES); what computes is, or
# the tests would take longer than is saved. The same holds for tests that compute much themselves (CELLMIRROR_COMPUTING_TESTS):
# those of ranging took 127 s at -O0 with sanitizers.
set(CELLMIRROR_TEST_OPTIONS)
set(CELLMIRROR_COMPUTING_TESTS "^(cell|collision|contact_model|dynamics|geometry|haptics|inverse_kinematics|kinematics|motion|ranging)")
set(CELLMIRROR_UNOPTIMISED)
set(CELLMIRROR_READS_AND_WRITES "^(config|drivers|ipc|scripts|sim_devices)(/|$)")
if(CELLMIRROR_SANITIZE)
  set(CELLMIRROR_UNOPTIMISED -O0)
  set(CELLMIRROR_TEST_OPTIONS -O0)
  set(CELLMIRROR_COMPUTING_TEST_OPTIONS -O1)
  if(CELLMIRROR_SANITIZE MATCHES "fuzzer")
    list(APPEND CELLMIRROR_TEST_OPTIONS -g0 -fno-sanitize=fuzzer-no-link)
    list(APPEND CELLMIRROR_COMPUTING_TEST_OPTIONS -g0 -fno-sanitize=fuzzer-no-link)
  endif()
elseif(CMAKE_BUILD_TYPE STREQUAL "RelWithDebInfo")
  set(CELLMIRROR_TEST_OPTIONS -O1 -g0)
endif()

# g++ collects its garbage while it compiles; with 500 MB before the first time a source takes up to a sixth less (9.8 s of processor
# time became 8.1 for one with JSON and threads).
add_compile_options("$<$<COMPILE_LANG_AND_ID:CXX,GNU>:SHELL:--param ggc-min-heapsize=500000>")

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Used where it is installed, but not among the packages of ./run and ./check: a first build, which finds nothing in the
  # cache, takes a third longer with it (10.9 s of processor time for eight sources instead of 7.9). The sloppiness is what
  # ccache's manual asks for where headers are precompiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

find_program(MOLD_PROGRAM mold)
if(MOLD_PROGRAM)
  add_link_options(-fuse-ld=mold)
endif()

find_package(Threads REQUIRED)

add_library(cellmirror_flags INTERFACE)
# Off for packages: another compiler may warn of more.
option(CELLMIRROR_WARNINGS_ARE_ERRORS "Warnings are errors" ON)
target_compile_options(cellmirror_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  $<$<BOOL:${CELLMIRROR_WARNINGS_ARE_ERRORS}>:-Werror>
  $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor -Woverloaded-virtual>)
# clang sees std::stable_sort of libstdc++ 12 use a function that the same header marks deprecated.
target_compile_options(cellmirror_flags INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wno-deprecated-declarations>)
target_include_directories(cellmirror_flags INTERFACE ${CMAKE_SOURCE_DIR})


if(CELLMIRROR_SANITIZE)
  add_compile_options(-fsanitize=${CELLMIRROR_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${CELLMIRROR_SANITIZE})
  if(CELLMIRROR_SANITIZE MATCHES "undefined")
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
  if(CELLMIRROR_SANITIZE MATCHES "fuzzer")
    # The build that every ./check makes goes without four checks at each access to memory, most of whose findings the address
    # sanitizer reports too: a source with much Eigen takes 11.2 s of processor time instead of 15.5. The preset asan has them.
    add_compile_options(-fno-sanitize=null,object-size,vptr,pointer-overflow)
  endif()
  add_compile_definitions(CELLMIRROR_SANITIZED=1)
endif()
