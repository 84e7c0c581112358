# Debian packages by CPack (scripts/package): `delray` (the program), `libdelray1` (libdelray.so.1, libdelray_icet.so.1
# and the libraries that are loaded on first use), `libdelray-dev` (headers, archives, CMake and pkg-config), `python3-delray`.
include_guard()
set(packages program library development)
set(package_of_program delray)
set(package_of_library libdelray1)
set(package_of_development libdelray-dev)
set(package_of_python3 python3-delray)
set(about_program
    "Renders scenes by a software rasterizer and a ray tracer on threads and MPI"
    "ranks, compares partitions and compositing schemes, and triangulates points"
    "in the plane and in space, exactly, in parallel, and beyond one memory.")
set(about_library
    "Triangulation, compositing over MPI, and rendering with the objects of ANARI"
    "1.0 by one header, delray.h; and libdelray_icet.so.1, by which ParaView and"
    "others composite in place of IceT. The program and the Python package load the"
    "libraries for files of pictures and rasters from this package.")
set(about_development
    "Headers and static archives for C++20, the header for C, and packages for"
    "CMake and pkg-config.")
set(about_python3
    "Delaunay triangulations with the interface of SciPy's, interpolation, scenes"
    "from arrays and files, pictures as NumPy arrays, compositing over mpi4py.")
# Beside what dpkg-shlibdeps finds. Static archives need what they link.
set(depends_program "libdelray1 (= ${PROJECT_VERSION})")
set(depends_library "")
string(CONCAT depends_development "libdelray1 (= ${PROJECT_VERSION}), libboost-context-dev, libdraco-dev, "
  "libembree-dev, libfmt-dev, libglm-dev, libhwy-dev, liblz4-dev, libjpeg-dev, libmeshoptimizer-dev, libopenmpi-dev, "
  "libpng-dev, libtbb-dev, libxxhash-dev, nlohmann-json3-dev")

if(DELRAY_PYTHON AND Python_VERSION_MAJOR)
  list(APPEND packages python3)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  string(CONCAT depends_python3 "libdelray1 (= ${PROJECT_VERSION}), python3 (>= 3.${Python_VERSION_MINOR}), "
         "python3 (<< 3.${next}), python3-numpy (>= 1:1.22)")
  set(path lib/python3/dist-packages)
  install(TARGETS delray_python_triangulation delray_python_render LIBRARY DESTINATION ${path}/delray
          COMPONENT python3 EXCLUDE_FROM_ALL)
  file(GLOB halves CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/python/delray/*.py ${PROJECT_SOURCE_DIR}/python/delray/*.pyi
       ${PROJECT_SOURCE_DIR}/python/delray/py.typed)
  install(FILES ${halves} DESTINATION ${path}/delray COMPONENT python3 EXCLUDE_FROM_ALL)
  file(WRITE ${PROJECT_BINARY_DIR}/packages/METADATA
       "Metadata-Version: 2.1\nName: delray\nVersion: ${PROJECT_VERSION}\nLicense: Apache-2.0\n"
       "Summary: ${PROJECT_DESCRIPTION}\nRequires-Dist: numpy (>=1.22)\n")
  install(FILES ${PROJECT_BINARY_DIR}/packages/METADATA
          DESTINATION ${path}/delray-${PROJECT_VERSION}.dist-info COMPONENT python3 EXCLUDE_FROM_ALL)
endif()

# What every package has to say of itself, where Debian's policy wants it.
set(texts ${PROJECT_BINARY_DIR}/packages)
configure_file(${PROJECT_SOURCE_DIR}/cmake/copyright.in ${texts}/copyright @ONLY)
set(contact "The authors of Delray <delray@delray.invalid>")
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${texts}/changelog "delray (${PROJECT_VERSION}) stable; urgency=medium\n\n"
     "  * See CHANGELOG.md of the sources.\n\n -- ${contact}  ${date}\n")
file(ARCHIVE_CREATE OUTPUT ${texts}/changelog.gz PATHS ${texts}/changelog FORMAT raw COMPRESSION GZip
     COMPRESSION_LEVEL 9)
foreach(package IN LISTS packages)
  install(FILES ${texts}/copyright ${texts}/changelog.gz
          DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${package_of_${package}} COMPONENT ${package} EXCLUDE_FROM_ALL)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "${contact}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL ${packages})
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(sections program graphics library libs development libdevel python3 python)
while(sections)
  list(POP_FRONT sections package section)
  string(TOUPPER ${package} name)
  list(JOIN about_${package} "\n" text)
  set(CPACK_DEBIAN_${name}_PACKAGE_NAME ${package_of_${package}})
  set(CPACK_DEBIAN_${name}_PACKAGE_SOURCE delray)
  set(CPACK_DEBIAN_${name}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${name}_PACKAGE_DEPENDS "${depends_${package}}")
  set(CPACK_COMPONENT_${name}_DESCRIPTION "${text}")
endwhile()
# Other packages' needs of libdelray.so.1, and that the loader is told of it.
file(WRITE ${texts}/shlibs "libdelray 1 libdelray1 (>= ${PROJECT_VERSION})\n"
     "libdelray_icet 1 libdelray1 (>= ${PROJECT_VERSION})\n")
file(WRITE ${texts}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${texts}/shlibs ${texts}/triggers)
# Python's compiled halves come and go with the package.
file(CONFIGURE OUTPUT ${texts}/postinst CONTENT "#!/bin/sh\nset -e\npy3compile -p python3-delray\n")
file(CONFIGURE OUTPUT ${texts}/prerm CONTENT "#!/bin/sh\nset -e\npy3clean -p python3-delray\n")
file(CHMOD ${texts}/postinst ${texts}/prerm PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
     WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PYTHON3_PACKAGE_CONTROL_EXTRA ${texts}/postinst ${texts}/prerm)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/compress_manual.cmake)
include(CPack)
