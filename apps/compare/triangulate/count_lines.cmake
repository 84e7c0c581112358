# Writes OUTPUT, a source with the lines of code of each method of triangulation in SOURCE_DIR: neither
# empty nor comments alone. A method has the files that its source includes of delaunay/, and so on, with the
# sources that belong to those headers. What sequential insertion has, too, counts for all of them alone.
cmake_minimum_required(VERSION 3.22)
set(entries  # of methods whose source is named otherwise
    "divide-and-conquer>divide_and_conquer/divide" "guibas-stolfi>divide_and_conquer/divide" "cavity>cavity/cavity_insertion")
foreach(name IN ITEMS batch pessimistic optimistic burglary circumcircle insertion)
  list(APPEND entries "${name}>history/${name}")
endforeach()
foreach(name IN ITEMS dewall incode teng bowyer-watson gift-wrapping quickhull sweep)
  string(REPLACE "-" "_" file ${name})
  list(APPEND entries "${name}>construction/${file}")
endforeach()
foreach(name IN ITEMS spielman chrisochoides)
  list(APPEND entries "${name}>cavity/${name}")
endforeach()

# Sets lines_of_<file> and included_by_<file>, once.
function(read_file file)
  if(DEFINED CACHE{lines_of_${file}})
    return()
  endif()
  file(STRINGS ${SOURCE_DIR}/${file} includes REGEX "^#include \"delaunay/[a-z_]+/")
  file(READ ${SOURCE_DIR}/${file} text)
  string(REGEX REPLACE "[];[]" "," text "${text}")  # which lists are made of
  string(REGEX MATCHALL "\n[ \t]*([^ \t\n/]|/[^/])" code "\n${text}")
  list(TRANSFORM includes REPLACE "^#include \"(.*)\"$" "\\1")
  list(LENGTH code lines)
  set(lines_of_${file} ${lines} CACHE INTERNAL "")
  set(included_by_${file} "${includes}" CACHE INTERNAL "")
endfunction()

foreach(entry IN LISTS entries)
  string(REPLACE ">" ";" entry "${entry}")
  list(GET entry 0 name)
  list(GET entry 1 path)
  list(APPEND names ${name})
  set(open delaunay/${path}.h)
  set(files)
  while(open)
    list(POP_FRONT open file)
    if(file IN_LIST files OR NOT EXISTS ${SOURCE_DIR}/${file})
      continue()
    endif()
    list(APPEND files ${file})
    read_file(${file})
    list(APPEND open ${included_by_${file}})
    string(REGEX REPLACE "\\.h$" ".cpp" source ${file})
    list(APPEND open ${source})
  endwhile()
  set(files_of_${name} ${files})
endforeach()

set(rows)
foreach(name IN LISTS names)
  set(own 0)
  set(all 0)
  foreach(file IN LISTS files_of_${name})
    math(EXPR all "${all} + ${lines_of_${file}}")
    if(NOT file IN_LIST files_of_insertion)
      math(EXPR own "${own} + ${lines_of_${file}}")
    endif()
  endforeach()
  string(APPEND rows "    {\"${name}\", ${own}, ${all}},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by apps/compare/triangulate/count_lines.cmake.
#include \"apps/compare/triangulate/method_lines.h\"

namespace delray::apps {
namespace {

constexpr MethodLines kLines[] = {
${rows}};

}  // namespace

std::span<const MethodLines> method_lines() { return kLines; }

}  // namespace delray::apps
")
