# `cmake --install`: libraries, headers, the program, and packages for find_package(delray COMPONENTS ...)
# and pkg-config, one component or delray-<component>.pc for each library.
include_guard()
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY DELRAY_LIBRARIES)
get_property(folders GLOBAL PROPERTY DELRAY_FOLDERS)
install(TARGETS ${libraries} EXPORT delrayTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
# Public headers lie directly in a folder. What they include of a sub-folder comes along.
foreach(folder IN LISTS folders)
  get_property(included GLOBAL PROPERTY DELRAY_INCLUDED_${folder})
  foreach(path IN ITEMS ${folder} LISTS included)
    file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${path}/*.h)
    if(headers)
      install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/delray/${path})
    endif()
  endforeach()
endforeach()

# What libraries link besides each other: the target, the package that has it, its flags for pkg-config.
set(packages
    "Threads::Threads,Threads,-pthread" "TBB::tbb,TBB,-ltbb" "glm::glm,glm," "hwy::hwy,hwy,-lhwy"
    "fmt::fmt,fmt,-lfmt" "PNG::PNG,PNG,-lpng" "JPEG::JPEG,JPEG,-ljpeg" "draco::draco,draco,-ldraco"
    "nlohmann_json::nlohmann_json,nlohmann_json," "meshoptimizer::meshoptimizer,meshoptimizer,-lmeshoptimizer" "MPI::MPI_C,MPI," "Boost::context,Boost,-lboost_context"
    "embree,embree,-lembree${embree_VERSION_MAJOR}")
foreach(package IN LISTS packages)
  string(REPLACE "," ";" package "${package}")
  list(GET package 0 target)
  list(GET package 1 package_of_${target})
  list(GET package 2 flags_of_${target})
endforeach()
list(JOIN MPI_C_LIBRARIES " " flags_of_MPI::MPI_C)

file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" up ${up})
set(DELRAY_NEEDS)  # for delrayConfig.cmake.in
foreach(folder IN LISTS folders)
  get_property(links GLOBAL PROPERTY DELRAY_LINKS_${folder})
  set(components)
  set(found)
  set(flags)
  foreach(link IN LISTS links)
    if(link MATCHES "^delray::(.*)")
      list(APPEND components ${CMAKE_MATCH_1})
    elseif(DEFINED package_of_${link})
      list(APPEND found ${package_of_${link}})
      list(APPEND flags ${flags_of_${link}})
    elseif(IS_ABSOLUTE "${link}")
      list(APPEND flags ${link})
    else()
      list(APPEND flags -l${link})
    endif()
  endforeach()
  string(APPEND DELRAY_NEEDS "set(delray_${folder}_components ${components})\n"
                             "set(delray_${folder}_packages ${found})\n")
  set(requires ${components})
  list(TRANSFORM requires PREPEND delray-)
  list(JOIN requires " " requires)
  set(library)
  get_target_property(type delray_${folder} TYPE)
  if(type STREQUAL STATIC_LIBRARY)
    set(library -ldelray_${folder})
  endif()
  list(JOIN flags " " flags)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/delray.pc.in
                 ${PROJECT_BINARY_DIR}/pkgconfig/delray-${folder}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/pkgconfig/delray-${folder}.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()

# libdelray.so needs none of them.
string(APPEND DELRAY_NEEDS "set(delray_c_components)\nset(delray_c_packages)\n")
list(APPEND folders c)

install(EXPORT delrayTargets NAMESPACE delray::
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/delray)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/delrayConfig.cmake.in
  ${PROJECT_BINARY_DIR}/delrayConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/delray)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/delrayConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/delrayConfig.cmake ${PROJECT_BINARY_DIR}/delrayConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/delray)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md
        DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/delray)
