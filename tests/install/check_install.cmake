# Installs the build into a scratch folder, builds the README's example against it, and runs it.
# cmake -D BUILD=... -D SOURCE=... -P check_install.cmake
cmake_minimum_required(VERSION 3.25)

file(READ ${SOURCE}/tests/install/example.cpp example)
file(READ ${SOURCE}/README.md readme)
string(FIND "${readme}" "${example}" place)
if(place EQUAL -1)
    message(FATAL_ERROR "README.md does not hold tests/install/example.cpp letter for letter")
endif()

set(scratch ${BUILD}/install_test)
file(REMOVE_RECURSE ${scratch})
function(must)
    execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output
        ERROR_VARIABLE output)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${ARGV}\n${output}")
    endif()
endfunction()
must(${CMAKE_COMMAND} --install ${BUILD} --prefix ${scratch}/prefix)
must(${CMAKE_COMMAND} -S ${SOURCE}/tests/install -B ${scratch}/build -G Ninja
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${scratch}/prefix)
must(${CMAKE_COMMAND} --build ${scratch}/build)
must(${scratch}/build/example ${SOURCE}/data/blob.off ${scratch}/blob.ply)
must(${scratch}/prefix/bin/surfelao info ${scratch}/blob.ply)
