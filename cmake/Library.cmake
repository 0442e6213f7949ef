cellmirror_precompiled(common)
if(CELLMIRROR_UNOPTIMISED)
  cellmirror_precompiled(unoptimised OPTIONS ${CELLMIRROR_UNOPTIMISED})
endif()

# app: its rooms put together what others compute, and no fuzz target sees them: with sanitizers they are not optimised and
# go without the fuzzer's counters, as tests do.
set(app_options)
if(CELLMIRROR_SANITIZE)
  set(app_options ${CELLMIRROR_TEST_OPTIONS})
endif()
set(app_headers <nlohmann/json.hpp>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")  # takes from a precompiled header only what a source uses; g++ reads it whole
  list(APPEND app_headers <condition_variable> <deque> <mutex> <stop_token> <thread> <unordered_map>)
  foreach(header app/snapshot/cell_state.hpp config/cell_file.hpp rt_core/engine/engine.hpp)
    list(APPEND app_headers ${CMAKE_SOURCE_DIR}/${header})
  endforeach()
endif()
cellmirror_precompiled(app HEADERS ${app_headers} LINK nlohmann_json::nlohmann_json OPTIONS ${app_options})

# Sources of a target are compiled several at a time, which parses headers and instantiates templates once for all of them.
option(CELLMIRROR_TOGETHER "Compile several sources of a target at a time: a whole build takes half as long, a changed source longer" ON)
set(CMAKE_UNITY_BUILD ${CELLMIRROR_TOGETHER})
# The more at a time the less is repeated: the 26 sources of app_test took clang with sanitizers 56 s of processor time in four
# batches and 28 s in one, with 1.8 GB of memory. What people change and build again, the release, has smaller ones: a changed
# source is compiled within 20 s. Where nobody builds again (./check --once, which CI runs) the release has large ones too.
set(CELLMIRROR_LARGE_BATCH 32)
option(CELLMIRROR_ONCE "Compile in large batches: the shortest first build, and long ones after a change" OFF)
if(CELLMIRROR_SANITIZE OR CELLMIRROR_ONCE)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE ${CELLMIRROR_LARGE_BATCH})
else()
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 8)
endif()

# cellmirror_apart(a.cpp b.cpp ...): sources of this folder that are compiled each by itself, since they use names of their own
# that another source of the target uses too.
function(cellmirror_apart)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# cellmirror_library(SOURCES a.cpp b.cpp USES rt_core/base ... PRIVATE fmt::fmt ... PUBLIC Eigen3::Eigen
#   [PRECOMPILED set])                                  the set of cmake/PrecompiledHeaders.cmake; else common
#
# One library a folder, named after it (rt_core/rt -> cellmirror_rt_core_rt). USES names folders of ours and is checked
# against cmake/Layers.cmake; PRIVATE and PUBLIC name third-party targets.
function(cellmirror_folder_target folder result)
  string(REPLACE "/" "_" name ${folder})
  set(${result} cellmirror_${name} PARENT_SCOPE)
endfunction()

function(cellmirror_link_folders target scope)
  foreach(used IN LISTS ARGN)
    cellmirror_folder_target(${used} used_target)
    if(NOT TARGET ${used_target})
      message(FATAL_ERROR "${target} uses ${used}, which has no library (yet)")
    endif()
    target_link_libraries(${target} ${scope} ${used_target})
  endforeach()
endfunction()

function(cellmirror_library)
  cmake_parse_arguments(ARG "" "PRECOMPILED" "SOURCES;USES;PRIVATE;PUBLIC" ${ARGN})
  file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  cellmirror_folder_target(${folder} target)
  cellmirror_check_layer(${folder} ${ARG_USES})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    target_link_libraries(${target} PRIVATE cellmirror_flags ${ARG_PRIVATE} PUBLIC Threads::Threads ${ARG_PUBLIC})
    target_include_directories(${target} PUBLIC ${CMAKE_SOURCE_DIR})
    if(folder MATCHES "^app/")
      target_compile_definitions(${target} PRIVATE CELLMIRROR_VERSION="${PROJECT_VERSION}")
    endif()
    cellmirror_link_folders(${target} PUBLIC ${ARG_USES})
    if(NOT ARG_PRECOMPILED)
      set(ARG_PRECOMPILED common)
      if(folder MATCHES "^app/" AND NOT folder STREQUAL "app/plot")
        set(ARG_PRECOMPILED app)
      endif()
      if(TARGET cellmirror_precompiled_unoptimised AND folder MATCHES ${CELLMIRROR_READS_AND_WRITES})
        set(ARG_PRECOMPILED unoptimised)
      endif()
    endif()
    cellmirror_use_precompiled(${target} ${ARG_PRECOMPILED})
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE ${CMAKE_SOURCE_DIR})
    target_link_libraries(${target} INTERFACE Threads::Threads ${ARG_PUBLIC})
    cellmirror_link_folders(${target} INTERFACE ${ARG_USES})
  endif()
endfunction()

# cellmirror_executable(name SOURCES ... USES ... LINK ... [PRECOMPILED set])
function(cellmirror_executable name)
  cmake_parse_arguments(ARG "" "PRECOMPILED" "SOURCES;USES;LINK" ${ARGN})
  file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  string(REGEX REPLACE "^tests/.*" "tests" folder ${folder})
  cellmirror_check_layer(${folder} ${ARG_USES})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE cellmirror_flags ${ARG_LINK})
  cellmirror_link_folders(${name} PRIVATE ${ARG_USES})
  if(NOT ARG_PRECOMPILED)
    set(ARG_PRECOMPILED common)
  endif()
  cellmirror_use_precompiled(${name} ${ARG_PRECOMPILED})
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "/tests/bench/" AND TARGET benches)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    add_dependencies(benches ${name})
  endif()
endfunction()
