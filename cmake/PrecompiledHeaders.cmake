# Headers that cost more than the code that includes them (the standard library, fmt, Eigen, GoogleTest, JSON) are parsed
# once a build and set of targets. Sources include what they use all the same; what a source does not need costs it
# nothing.
option(CELLMIRROR_PRECOMPILE "Parse the large headers of libraries once a build" ON)
if(CELLMIRROR_PRECOMPILE)  # for ccache, which otherwise does not know what is in a precompiled header
  add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess> "$<$<COMPILE_LANG_AND_ID:CXX,Clang>:SHELL:-Xclang -fno-pch-timestamp>")
endif()

# In every set.
set(CELLMIRROR_COMMON_HEADERS <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <expected> <filesystem> <functional> <map>
  <memory> <optional> <span> <string> <string_view> <utility> <variant> <vector> <fmt/format.h> <Eigen/Geometry>)

# cellmirror_precompiled(set HEADERS <a.h> ... LINK targets ... OPTIONS ...): OPTIONS of the compiler hold for the headers and
# for every target that uses the set.
function(cellmirror_precompiled set)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINK;OPTIONS" ${ARGN})
  if(NOT CELLMIRROR_PRECOMPILE)
    return()
  endif()
  set(source ${CMAKE_BINARY_DIR}/precompiled/${set}.cpp)
  file(GENERATE OUTPUT ${source} CONTENT "")
  add_library(cellmirror_precompiled_${set} OBJECT ${source})
  target_link_libraries(cellmirror_precompiled_${set} PRIVATE cellmirror_flags Threads::Threads fmt::fmt Eigen3::Eigen ${ARG_LINK})
  target_compile_options(cellmirror_precompiled_${set} PRIVATE ${ARG_OPTIONS})
  set_target_properties(cellmirror_precompiled_${set} PROPERTIES CELLMIRROR_OPTIONS "${ARG_OPTIONS}")
  set(headers ${CELLMIRROR_COMMON_HEADERS} ${ARG_HEADERS})
  target_precompile_headers(cellmirror_precompiled_${set} PRIVATE ${headers})
  # CMake gives the file that lists them an old time, so ninja would not see that the list has changed.
  if(NOT "${CELLMIRROR_PRECOMPILED_${set}}" STREQUAL "${headers}")
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/cellmirror_precompiled_${set}.dir)
    file(REMOVE ${folder}/cmake_pch.hxx.pch ${folder}/cmake_pch.hxx.gch)
    set(CELLMIRROR_PRECOMPILED_${set} "${headers}" CACHE INTERNAL "")
  endif()
endfunction()

# cellmirror_use_precompiled(target set): set none is for a target that has sources in C as well. The sources of `target`
# that have compile options of their own (kernels for an instruction set) do without.
function(cellmirror_use_precompiled target set)
  if(NOT TARGET cellmirror_precompiled_${set})
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  if(NOT sources MATCHES "[.]cpp")
    return()
  endif()
  foreach(source IN LISTS sources)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(options)
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
  get_target_property(of_the_set cellmirror_precompiled_${set} CELLMIRROR_OPTIONS)
  target_compile_options(${target} PRIVATE ${of_the_set})
  get_target_property(definitions fmt::fmt INTERFACE_COMPILE_DEFINITIONS)  # have to be those of the set
  target_compile_definitions(${target} PRIVATE ${definitions})
  # GCC 12 forgets with a precompiled header what code came from a system header, and warns of the standard library's, where
  # it was inlined. Those warnings of its optimiser are off; clang compiles everything too.
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict -Wno-stringop-overflow
    -Wno-stringop-overread -Wno-array-bounds -Wno-error=maybe-uninitialized -Wno-error=free-nonheap-object
    -Wno-error=dangling-pointer -Wno-error=use-after-free -Wno-error=nonnull>)
  if(CMAKE_UNITY_BUILD)  # what is private to a source looks to g++ as if it came from a header
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
  endif()
  target_precompile_headers(${target} REUSE_FROM cellmirror_precompiled_${set})
endfunction()
