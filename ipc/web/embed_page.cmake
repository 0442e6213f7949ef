# Run as a script: cmake -DPAGE=folder -DOUTPUT=page_files_data.cpp -DFUNCTION=page_files "-DFILES=a|b" "-DLIBRARIES=c=/path/of/c" -P embed_page.cmake
# Writes the files as string literals, beside each its compressed form, so that the page needs no file at run time.
set(TYPES ".html=text/html\; charset=utf-8" ".css=text/css\; charset=utf-8" ".js=text/javascript\; charset=utf-8"
  ".svg=image/svg+xml" ".png=image/png" ".ico=image/x-icon" ".json=application/json" ".txt=text/plain\; charset=utf-8"
  ".webmanifest=application/manifest+json" ".woff2=font/woff2")

function(content_type file result)
  get_filename_component(extension ${file} LAST_EXT)
  set(${result} "application/octet-stream" PARENT_SCOPE)
  foreach(row IN LISTS TYPES)
    string(FIND "${row}" "${extension}=" at)
    if(at EQUAL 0)
      string(LENGTH "${extension}=" length)
      string(SUBSTRING "${row}" ${length} -1 type)
      set(${result} "${type}" PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# Hexadecimal digits as a literal, in pieces, since compilers bound the length of a line.
function(literal hex result)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" text "${hex}")
  string(LENGTH "${text}" length)
  set(pieces "")
  set(at 0)
  while(at LESS length)
    string(SUBSTRING "${text}" ${at} 16000 piece)
    string(APPEND pieces "\n    \"${piece}\"")
    math(EXPR at "${at} + 16000")
  endwhile()
  if(pieces STREQUAL "")
    set(pieces "\"\"")
  endif()
  set(${result} "${pieces}" PARENT_SCOPE)
endfunction()

set(rows "")
set(data "")
set(number 0)
string(REPLACE "|" ";" FILES "${FILES}")
string(REPLACE "|" ";" LIBRARIES "${LIBRARIES}")
set(from_page "")
foreach(file IN LISTS FILES)
  list(APPEND from_page "${file}=${PAGE}/${file}")
endforeach()
set(all ${from_page} ${LIBRARIES})
list(SORT all)
foreach(entry IN LISTS all)
  string(REGEX REPLACE "=.*" "" file "${entry}")
  string(REGEX REPLACE "^[^=]*=" "" source "${entry}")
  if(file STREQUAL "index.html")
    set(path "/")
  else()
    set(path "/page/${file}")
  endif()
  content_type(${file} type)
  file(SIZE ${source} size)
  file(READ ${source} hex HEX)
  file(SHA256 ${source} hash)
  string(SUBSTRING ${hash} 0 24 etag)
  # Bytes 4 to 7 of the compressed file are the time of compression (RFC 1952): zeroed, so that builds are alike.
  file(ARCHIVE_CREATE OUTPUT ${OUTPUT}.gz PATHS ${source} FORMAT raw COMPRESSION GZip COMPRESSION_LEVEL 9)
  file(SIZE ${OUTPUT}.gz gzip_size)
  file(READ ${OUTPUT}.gz gzip_hex HEX)
  file(REMOVE ${OUTPUT}.gz)
  string(SUBSTRING "${gzip_hex}" 0 8 before)
  string(SUBSTRING "${gzip_hex}" 16 -1 behind)
  set(gzip_hex "${before}00000000${behind}")
  if(NOT gzip_size LESS size)
    set(gzip_size 0)
    set(gzip_hex "")
  endif()
  literal("${hex}" bytes)
  literal("${gzip_hex}" gzip)
  string(APPEND data "constexpr char kBytes${number}[] = ${bytes};\nconstexpr char kGzip${number}[] = ${gzip};\n")
  string(APPEND rows "    {\"${path}\", \"${type}\", \"\\\"${etag}\\\"\", {kBytes${number}, ${size}}, {kGzip${number}, ${gzip_size}}},\n")
  math(EXPR number "${number} + 1")
endforeach()

if(number EQUAL 0)
  message(FATAL_ERROR "there are no files of the page in ${PAGE}")
endif()
file(WRITE ${OUTPUT} "// Made by embed_page.cmake.
#include <array>

#include \"ipc/web/page_files.hpp\"

namespace cellmirror::web {

namespace {

${data}
constexpr std::array<PageFile, ${number}> kFiles = {{
${rows}}};

}  // namespace

std::span<const PageFile> ${FUNCTION}() { return kFiles; }

}  // namespace cellmirror::web
")
