# Each test carries its kind (tests/<kind>/<subject>) as a label; LABELS adds others, e.g. concurrency: runs under
# ThreadSanitizer as well, as every stress test does. Integration and stress tests run alone, since they watch
# the clock or share ports, unless their CMakeLists.txt says otherwise (RESOURCE_LOCK gateway: one gateway at a time).
# LABELS peers: compares with a program of others; ./check --peers installs all of these.
#
# cellmirror_test(name SOURCES ... USES ... [LINK ...] [LABELS ...] [RELEASE_ONLY | RELEASE_TOO] [PRECOMPILED none])  a GoogleTest program, one ctest entry.
#   PRECOMPILED none: with sources in C (cmake/PrecompiledHeaders.cmake).
#   Unit and golden tests: a whole ./check builds and runs each once, with sanitizers. In a release build they are made by
#     tests_sanitized only (./check --quick) and labelled "sanitized".
#   RELEASE_ONLY: not built with sanitizers. For long comparisons of numbers whose code a fuzz target runs under them.
#   RELEASE_TOO: in both. For what the optimiser, real clocks or locked memory may change.
# cellmirror_fuzz_target(name SOURCE f.cpp CORPUS dir USES ... [LINK ...]) an LLVMFuzzerTestOneInput function: with
#   CELLMIRROR_FUZZERS a libFuzzer program, which begins with the corpus, else <name>_replay, which runs that as an ordinary
#   test; where it is built it is as with unit tests.
# cellmirror_benchmark(name SOURCES ... USES ... [LINK ...] [SMOKE])       with SMOKE, a short round of it is a test (./check --label bench, --full)
if(CELLMIRROR_TESTS)
  enable_testing()
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
if(CELLMIRROR_TESTS AND CELLMIRROR_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()

# tests_<label>: builds the test programs of one label.
foreach(label unit integration golden fuzz stress concurrency sanitized)
  add_custom_target(tests_${label})
endforeach()

# Builds the programs of tests/bench, for ./check --label bench and --full.
add_custom_target(benches)

# What nearly every unit test includes is parsed once a build (PrecompiledHeaders.cmake).
if(CELLMIRROR_TESTS)
  cellmirror_precompiled(tests HEADERS <gtest/gtest.h> LINK GTest::gtest OPTIONS ${CELLMIRROR_TEST_OPTIONS})
  if(CELLMIRROR_SANITIZE)
    cellmirror_precompiled(tests_computing HEADERS <gtest/gtest.h> LINK GTest::gtest OPTIONS ${CELLMIRROR_COMPUTING_TEST_OPTIONS})
  endif()
endif()

# cellmirror_describe_test(name): kind label, serial where needed, and what every test may rely on in its environment.
# For tests added with add_test() by hand too. Sanitizers make a program up to ten times slower.
function(cellmirror_describe_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "LABELS" ${ARGN})
  file(RELATIVE_PATH place ${CMAKE_SOURCE_DIR}/tests ${CMAKE_CURRENT_SOURCE_DIR})
  string(REGEX MATCH "^[^/]+" kind ${place})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(CELLMIRROR_SANITIZE)
    math(EXPR ARG_TIMEOUT "${ARG_TIMEOUT} * 3")
  endif()
  if(kind MATCHES "^(integration|stress|bench|docs)$")
    set_tests_properties(${name} PROPERTIES RUN_SERIAL ON)
  endif()
  list(APPEND ARG_LABELS ${kind})
  list(REMOVE_DUPLICATES ARG_LABELS)
  foreach(label IN LISTS ARG_LABELS)
    if(TARGET ${name} AND TARGET tests_${label})
      add_dependencies(tests_${label} ${name})
    endif()
  endforeach()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS "${ARG_LABELS}" SKIP_RETURN_CODE 77
    ENVIRONMENT "CELLMIRROR_SOURCE_DIR=${CMAKE_SOURCE_DIR};CELLMIRROR_BIN_DIR=${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
endfunction()

# Takes a unit or golden test or a fuzz target out of what a release build makes by itself.
function(cellmirror_leave_to_sanitizers name labels)
  file(RELATIVE_PATH place ${CMAKE_SOURCE_DIR}/tests ${CMAKE_CURRENT_SOURCE_DIR})
  if(NOT CELLMIRROR_SANITIZE AND place MATCHES "^(unit|golden|fuzz)/")
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    set(${labels} ${${labels}} sanitized PARENT_SCOPE)
  endif()
endfunction()

function(cellmirror_test name)
  if(NOT CELLMIRROR_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "RELEASE_ONLY;RELEASE_TOO" "TIMEOUT;PRECOMPILED" "SOURCES;USES;LINK;LABELS" ${ARGN})
  if(ARG_RELEASE_ONLY AND CELLMIRROR_SANITIZE)
    return()
  endif()
  if(NOT ARG_PRECOMPILED)
    set(ARG_PRECOMPILED tests)
    get_filename_component(subject ${CMAKE_CURRENT_SOURCE_DIR} NAME)
    if(CELLMIRROR_SANITIZE AND subject MATCHES "${CELLMIRROR_COMPUTING_TESTS}")
      set(ARG_PRECOMPILED tests_computing)
    endif()
  endif()
  set(CMAKE_UNITY_BUILD_BATCH_SIZE ${CELLMIRROR_LARGE_BATCH})
  cellmirror_executable(${name} SOURCES ${ARG_SOURCES} USES ${ARG_USES} LINK GTest::gtest GTest::gmock GTest::gtest_main ${ARG_LINK}
    PRECOMPILED ${ARG_PRECOMPILED})
  add_test(NAME ${name} COMMAND ${name} --gtest_brief=1)
  if(NOT ARG_RELEASE_ONLY AND NOT ARG_RELEASE_TOO)
    cellmirror_leave_to_sanitizers(${name} ARG_LABELS)
  endif()
  cellmirror_describe_test(${name} TIMEOUT ${ARG_TIMEOUT} LABELS ${ARG_LABELS})
endfunction()

function(cellmirror_fuzz_target name)
  if(NOT CELLMIRROR_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "SOURCE;CORPUS" "USES;LINK" ${ARGN})
  if(NOT CELLMIRROR_FUZZERS)  # libFuzzer begins with the corpus by itself
    cellmirror_executable(${name}_replay SOURCES ${ARG_SOURCE} ${CMAKE_SOURCE_DIR}/tests/fuzz/replay_main.cpp USES ${ARG_USES} LINK ${ARG_LINK})
    add_test(NAME ${name}_replay COMMAND ${name}_replay ${CMAKE_CURRENT_SOURCE_DIR}/${ARG_CORPUS})
    set(labels fuzz)
    cellmirror_leave_to_sanitizers(${name}_replay labels)
    cellmirror_describe_test(${name}_replay LABELS ${labels})
  else()
    cellmirror_executable(${name} SOURCES ${ARG_SOURCE} USES ${ARG_USES} LINK ${ARG_LINK} -fsanitize=fuzzer)
    add_test(NAME ${name} COMMAND ${CMAKE_SOURCE_DIR}/tests/support/fuzz_for.sh $<TARGET_FILE:${name}> ${CMAKE_CURRENT_SOURCE_DIR}/${ARG_CORPUS})
    cellmirror_describe_test(${name} LABELS fuzz libfuzzer)
  endif()
endfunction()

function(cellmirror_benchmark name)
  if(NOT (CELLMIRROR_TESTS AND CELLMIRROR_BENCHMARKS))
    return()
  endif()
  cmake_parse_arguments(ARG "SMOKE" "" "SOURCES;USES;LINK" ${ARGN})
  cellmirror_executable(${name} SOURCES ${ARG_SOURCES} USES ${ARG_USES} LINK benchmark::benchmark ${ARG_LINK})
  if(ARG_SMOKE)
    add_test(NAME ${name}_smoke COMMAND ${name} --benchmark_min_time=0.01)
    cellmirror_describe_test(${name}_smoke)
  endif()
endfunction()
