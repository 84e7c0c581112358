# delray_library(<folder> [INCLUDED <sub-folder>...] [FIRST <source>...] [ALONE <source>...]
#                [DEPENDS <target>...] [PRIVATE_DEPENDS <target>...])
#
# One static library per folder, made of every .cpp in it and in its sub-folders but for those that have
# a CMakeLists.txt of their own, known as delray::<folder>. Adding a source file or a sub-folder needs no
# change here or there. Headers directly in the folder are public; INCLUDED are the sub-folders with
# headers that those include. For FIRST and ALONE see delray_compile_together.
include_guard()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()
find_program(DELRAY_CCACHE ccache)
if(DELRAY_CCACHE)
  # Without this ccache does not keep what was compiled with a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros ${DELRAY_CCACHE})
endif()

option(DELRAY_TOGETHER "Compile several sources in one go" ON)

add_library(delray_warnings INTERFACE)
target_compile_options(delray_warnings INTERFACE -Wall -Wextra -Wshadow
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # GCC 12: false on std::string + (PR105329)
                       $<$<BOOL:${DELRAY_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13
   AND NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
  # False as well, once <string> is precompiled.
  target_compile_options(delray_warnings INTERFACE -Wno-array-bounds -Wno-stringop-overflow
                                                   -Wno-stringop-overread)
endif()
if(DELRAY_TOGETHER AND CMAKE_CXX_COMPILER_ID MATCHES Clang)
  # It takes names of one source to be hidden by those in headers of another.
  target_compile_options(delray_warnings INTERFACE -Wno-shadow)
endif()
if(DELRAY_SANITIZE)
  # GCC 12 takes parts of <regex> for uninitialized then.
  add_compile_options(-fsanitize=${DELRAY_SANITIZE} -fno-omit-frame-pointer -g1
                      $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  # The sanitizers call dlopen in our place: a RUNPATH would be theirs.
  add_link_options(-fsanitize=${DELRAY_SANITIZE} -Wl,--disable-new-dtags)
  if(DELRAY_SANITIZE MATCHES undefined)
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
  # What the code asks for; compilers spell it differently.
  if(DELRAY_SANITIZE MATCHES address)
    add_compile_definitions(DELRAY_ASAN)
  endif()
  if(DELRAY_SANITIZE MATCHES thread)
    add_compile_definitions(DELRAY_TSAN)
  endif()
endif()

# The instruction sets that Highway compiles for. Not for SSSE3: processors without SSE4, the last of
# 2013, get the code for SSE2. Not for vectors of a length that the compiler does not know, which
# cannot be members of structures: machines that have them have NEON too.
add_compile_definitions(
  "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SVE|HWY_SVE_256|HWY_SVE2|HWY_SVE2_128)")

# What many sources include, parsed once for all libraries.
set(DELRAY_COMMON_HEADERS
    <algorithm> <array> <atomic> <bit> <cassert> <charconv> <chrono> <cmath> <cstddef> <cstdint> <cstring>
    <deque> <exception> <filesystem> <functional> <limits> <map> <memory> <mutex> <numeric> <optional>
    <span> <stdexcept> <string> <string_view> <thread> <tuple> <utility> <vector> <glm/glm.hpp>)
if(NOT TARGET delray_headers)
  add_library(delray_headers STATIC ${CMAKE_CURRENT_LIST_DIR}/common_headers.cpp)
  target_compile_options(delray_headers PRIVATE -ffp-contract=off)
  target_link_libraries(delray_headers PRIVATE delray_warnings)
  target_precompile_headers(delray_headers PRIVATE ${DELRAY_COMMON_HEADERS})
endif()

# delray_compile_together(<target> [SIZE <sources>] [FIRST <source>...] [ALONE <source>...])
#
# A unity build: half of the time of a small source goes into headers, so about SIZE (six) of a target are
# compiled in one go. Those of FIRST go together, so that users of a heavy header share it; of the others
# those of a sub-folder, cut evenly where they are many, and small sub-folders one after the other: a
# source that is added has no others compiled anew but its neighbours. Private names must differ within a
# target; where two of a group do not, the compiler says where. Alone are those of ALONE, which take long by
# themselves, and those that Highway compiles once per instruction set. -DDELRAY_TOGETHER=OFF compiles each
# alone; with -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON as well, sources show what they fail to include.
function(delray_compile_together target)
  cmake_parse_arguments(ARG "" "SIZE" "FIRST;ALONE" ${ARGN})
  if(NOT ARG_SIZE)
    set(ARG_SIZE 6)
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${DELRAY_TOGETHER} UNITY_BUILD_MODE GROUP)
  if(DELRAY_TOGETHER AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)  # takes sources for headers
  endif()
  get_target_property(sources ${target} SOURCES)
  list(TRANSFORM ARG_FIRST PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  list(TRANSFORM ARG_ALONE PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  set(folders)
  foreach(source IN LISTS sources)
    file(STRINGS ${source} highway REGEX "^#define HWY_TARGET_INCLUDE" LIMIT_COUNT 1)
    if(highway OR source IN_LIST ARG_ALONE)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      continue()
    endif()
    if(source IN_LIST ARG_FIRST)
      set(folder ${CMAKE_CURRENT_SOURCE_DIR}/first)
    else()
      cmake_path(GET source PARENT_PATH folder)
    endif()
    if(NOT folder IN_LIST folders)
      list(APPEND folders ${folder})
    endif()
    list(APPEND "sources_${folder}" ${source})
  endforeach()
  math(EXPR few "${ARG_SIZE} + 1")
  math(EXPR many "${ARG_SIZE} + ${ARG_SIZE} / 2 + 1")
  set(collected ${many})  # sources of small folders in the group called `small`
  foreach(folder IN LISTS folders)
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${folder})
    string(MAKE_C_IDENTIFIER "${target}_${name}" name)
    list(LENGTH "sources_${folder}" size)
    if(size LESS_EQUAL few)
      math(EXPR collected "${collected} + ${size}")
      if(collected GREATER many)
        set(small ${name})
        set(collected ${size})
      endif()
      delray_unity_group(${small} ${sources_${folder}})
      continue()
    endif()
    math(EXPR cuts "(${size} + ${ARG_SIZE} / 2) / ${ARG_SIZE}")
    foreach(cut RANGE 1 ${cuts})
      math(EXPR begin "${size} * (${cut} - 1) / ${cuts}")
      math(EXPR length "${size} * ${cut} / ${cuts} - ${begin}")
      list(SUBLIST "sources_${folder}" ${begin} ${length} part)
      delray_unity_group("${name}_${cut}" ${part})
    endforeach()
  endforeach()
endfunction()

# delray_unity_group(<name> <source>...): those are compiled in one go.
function(delray_unity_group name)
  set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${name})
endfunction()

# delray_sources(<variable> <pattern>): the sources of this folder and of its sub-folders without a
# CMakeLists.txt.
function(delray_sources variable pattern)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${pattern})
  file(GLOB_RECURSE others ${CMAKE_CURRENT_SOURCE_DIR}/*/CMakeLists.txt)
  foreach(other IN LISTS others)
    cmake_path(GET other PARENT_PATH other)
    list(FILTER sources EXCLUDE REGEX "^${other}/")
  endforeach()
  set(${variable} ${sources} PARENT_SCOPE)
endfunction()

function(delray_library folder)
  cmake_parse_arguments(ARG "" "" "INCLUDED;FIRST;ALONE;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  delray_sources(sources *.cpp)
  set(target delray_${folder})
  if(sources)
    add_library(${target} STATIC ${sources})
    target_link_libraries(${target} PUBLIC ${ARG_DEPENDS})
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:delray_warnings>
                                            ${ARG_PRIVATE_DEPENDS})
    target_precompile_headers(${target} REUSE_FROM delray_headers)
    delray_compile_together(${target} FIRST ${ARG_FIRST} ALONE ${ARG_ALONE})
    set(scope PUBLIC)
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${ARG_DEPENDS} ${ARG_PRIVATE_DEPENDS})
    set(scope INTERFACE)
  endif()
  # Exact predicates and the picture contract both break under fused multiply-add, in the code of
  # anyone who includes our inline functions too.
  target_compile_options(${target} ${scope} -ffp-contract=off)
  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                $<INSTALL_INTERFACE:include/delray>)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${folder})
  add_library(delray::${folder} ALIAS ${target})
  set_property(GLOBAL APPEND PROPERTY DELRAY_LIBRARIES ${target})
  set_property(GLOBAL APPEND PROPERTY DELRAY_FOLDERS ${folder})
  set_property(GLOBAL PROPERTY DELRAY_LINKS_${folder} ${ARG_DEPENDS} ${ARG_PRIVATE_DEPENDS})
  list(TRANSFORM ARG_INCLUDED PREPEND ${folder}/)
  set_property(GLOBAL PROPERTY DELRAY_INCLUDED_${folder} ${ARG_INCLUDED})
endfunction()
