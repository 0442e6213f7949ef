# Headers that cost more than the code that includes them (Eigen, GoogleTest, JSON) are parsed once a build and set of
# targets. Sources include what they use all the same.
option(CELLMIRROR_PRECOMPILE "Parse the large headers of libraries once a build" ON)
if(CELLMIRROR_PRECOMPILE)  # for ccache, which otherwise does not know what is in a precompiled header
  add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess> "$<$<COMPILE_LANG_AND_ID:CXX,Clang>:SHELL:-Xclang -fno-pch-timestamp>")
endif()

# cellmirror_precompiled(set HEADERS <a.h> ... LINK targets ...)
function(cellmirror_precompiled set)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINK" ${ARGN})
  if(NOT CELLMIRROR_PRECOMPILE)
    return()
  endif()
  set(source ${CMAKE_BINARY_DIR}/precompiled/${set}.cpp)
  file(GENERATE OUTPUT ${source} CONTENT "")
  add_library(cellmirror_precompiled_${set} OBJECT ${source})
  target_link_libraries(cellmirror_precompiled_${set} PRIVATE cellmirror_flags Threads::Threads ${ARG_LINK})
  target_precompile_headers(cellmirror_precompiled_${set} PRIVATE ${ARG_HEADERS})
endfunction()

# GCC 12 forgets with a precompiled header that std::string's code came from a system header, and sometimes warns that
# appending to one were an overflow: give such a source the property SKIP_PRECOMPILE_HEADERS.
# The sources of `target` that have compile options of their own (kernels for an instruction set) do without.
function(cellmirror_use_precompiled target set)
  if(NOT TARGET cellmirror_precompiled_${set})
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(options)
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
  target_precompile_headers(${target} REUSE_FROM cellmirror_precompiled_${set})
endfunction()
