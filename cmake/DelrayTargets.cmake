# delray_library(<folder> [DEPENDS <target>...] [PRIVATE_DEPENDS <target>...])
#
# One static library per folder, made of every .cpp in it, known as delray::<folder>. Adding a source
# file needs no change here or there.
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

add_library(delray_warnings INTERFACE)
target_compile_options(delray_warnings INTERFACE -Wall -Wextra -Wshadow
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # GCC 12: false on std::string + (PR105329)
                       $<$<BOOL:${DELRAY_WERROR}>:-Werror>)
if(DELRAY_SANITIZE)
  add_compile_options(-fsanitize=${DELRAY_SANITIZE} -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${DELRAY_SANITIZE})
  if(DELRAY_SANITIZE MATCHES undefined)
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()

# The instruction sets that Highway compiles for. Not for SSSE3: processors without SSE4, the last of
# 2013, get the code for SSE2. Not for vectors of a length that the compiler does not know, which
# cannot be members of structures: machines that have them have NEON too.
add_compile_definitions(
  "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SVE|HWY_SVE_256|HWY_SVE2|HWY_SVE2_128)")

# What most sources include, parsed once for all libraries; nothing that brings in <string>, of which
# GCC 12 warns where it does not come straight from a system header.
set(DELRAY_COMMON_HEADERS <algorithm> <array> <cstdint> <cstring> <functional> <optional> <span>
                          <vector> <glm/glm.hpp>)
if(NOT TARGET delray_headers)
  add_library(delray_headers STATIC ${CMAKE_CURRENT_LIST_DIR}/common_headers.cpp)
  target_compile_options(delray_headers PRIVATE -ffp-contract=off)
  target_link_libraries(delray_headers PRIVATE delray_warnings)
  target_precompile_headers(delray_headers PRIVATE ${DELRAY_COMMON_HEADERS})
endif()

function(delray_library folder)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  set(target delray_${folder})
  if(sources)
    add_library(${target} STATIC ${sources})
    target_link_libraries(${target} PUBLIC ${ARG_DEPENDS})
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:delray_warnings>
                                            ${ARG_PRIVATE_DEPENDS})
    target_precompile_headers(${target} REUSE_FROM delray_headers)
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
endfunction()
