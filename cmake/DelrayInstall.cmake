# `cmake --install`: libraries, headers, the program, and a package for find_package(delray).
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
    install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/delray/${path})
  endforeach()
endforeach()
install(EXPORT delrayTargets NAMESPACE delray::
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/delray)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/delrayConfig.cmake.in
  ${PROJECT_BINARY_DIR}/delrayConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/delray)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/delrayConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/delrayConfig.cmake ${PROJECT_BINARY_DIR}/delrayConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/delray)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/delray)
