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
run(${WORK_DIR}/prefix/bin/delray --version)
set(share ${WORK_DIR}/prefix/share)
run(${CMAKE_COMMAND} -E compare_files ${SOURCE_DIR}/../../LICENSE ${share}/doc/delray/LICENSE)
foreach(page man/man1/delray.1 bash-completion/completions/delray zsh/site-functions/_delray
             fish/vendor_completions.d/delray.fish)
  file(SIZE ${share}/${page} size)
  if(size EQUAL 0)
    message(FATAL_ERROR "${page} is empty")
  endif()
endforeach()
# With the library that it loads for pictures.
run(${WORK_DIR}/prefix/bin/delray render gen:cornell:100 --size 16x16 -q -o ${WORK_DIR}/picture.png)
