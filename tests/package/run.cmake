# Installs the build into a folder, configures and builds this folder against it, runs the program.
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/build -G Ninja -DCMAKE_CXX_COMPILER=${CXX}
    -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/consumer)
# One component, without what others need.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/points -B ${WORK_DIR}/points -G Ninja -DCMAKE_CXX_COMPILER=${CXX}
    -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/points)
run(${WORK_DIR}/points/points)
# The same without CMake.
find_program(pkg_config pkg-config REQUIRED)
file(GLOB_RECURSE descriptions ${WORK_DIR}/prefix/*/delray-delaunay.pc)
cmake_path(GET descriptions PARENT_PATH descriptions)
run(sh -c "PKG_CONFIG_PATH='${descriptions}' && export PKG_CONFIG_PATH && '${CXX}' '${SOURCE_DIR}/points/points.cpp' $('${pkg_config}' --cflags --libs delray-delaunay) -o '${WORK_DIR}/points/by_pkg_config'")
run(${WORK_DIR}/points/by_pkg_config)
# And from C.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/c -B ${WORK_DIR}/c -G Ninja -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/c)
run(${WORK_DIR}/c/consumer)
find_program(c_compiler cc REQUIRED)
run(sh -c "PKG_CONFIG_PATH='${descriptions}' && export PKG_CONFIG_PATH && '${c_compiler}' '${SOURCE_DIR}/c/consumer.c' $('${pkg_config}' --cflags --libs delray) -o '${WORK_DIR}/c/by_pkg_config'")
get_filename_component(libraries ${descriptions} DIRECTORY)
run(${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${libraries} ${WORK_DIR}/c/by_pkg_config)
run(${WORK_DIR}/prefix/bin/delray --version)
set(share ${WORK_DIR}/prefix/share)
foreach(text IN ITEMS LICENSE THIRD_PARTY.md)
  run(${CMAKE_COMMAND} -E compare_files ${SOURCE_DIR}/../../${text} ${share}/doc/delray/${text})
endforeach()
foreach(page man/man1/delray.1 bash-completion/completions/delray zsh/site-functions/_delray
             fish/vendor_completions.d/delray.fish)
  file(SIZE ${share}/${page} size)
  if(size EQUAL 0)
    message(FATAL_ERROR "${page} is empty")
  endif()
endforeach()
# With the library that it loads for pictures.
run(${WORK_DIR}/prefix/bin/delray render gen:cornell:100 --size 16x16 -q -o ${WORK_DIR}/picture.png)
