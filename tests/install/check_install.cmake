# Installs the build into a scratch folder, looks at what is there, builds the README's example against
# it, and runs it.
# cmake -D BUILD=... -D SOURCE=... [-D PYTHON=...] -P check_install.cmake
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
    set(output "${output}" PARENT_SCOPE)
endfunction()
must(${CMAKE_COMMAND} --install ${BUILD} --prefix ${scratch}/prefix)

# no header but the public ones
file(GLOB_RECURSE headers RELATIVE ${scratch}/prefix/include ${scratch}/prefix/include/*)
set(public engines/engine.h engines/threads.h files/scene_io.h files/vertex_colors.h
    surfelao.h surfels/base_colors.h
    surfels/errors.h surfels/geometry.h surfels/occlusion.h surfels/progress.h
    surfels/receiver.h surfels/scene.h surfels/share.h surfels/surface.h)
list(TRANSFORM public PREPEND surfelao/)
list(SORT headers)
list(SORT public)
if(NOT headers STREQUAL public)
    message(FATAL_ERROR "installed headers: ${headers}\nwanted: ${public}")
endif()

# what is not code, and programs that find their parts without a path of the build
foreach(file IN ITEMS man/man1/surfelao.1 man/man1/surfelao-bake.1
        bash-completion/completions/surfelao zsh/vendor-completions/_surfelao
        fish/vendor_completions.d/surfelao.fish applications/surfelao.desktop
        icons/hicolor/scalable/apps/surfelao.svg mime/packages/surfelao.xml
        doc/surfelao/README.md doc/surfelao/docs/install.md doc/surfelao/examples/blob.off)
    if(NOT EXISTS ${scratch}/prefix/share/${file})
        message(FATAL_ERROR "share/${file} is not installed")
    endif()
endforeach()
file(GLOB_RECURSE modules ${scratch}/prefix/lib/*.so)
foreach(binary IN LISTS modules ITEMS ${scratch}/prefix/bin/surfelao)
    must(readelf -d ${binary})
    if(output MATCHES "RPATH|RUNPATH")
        message(FATAL_ERROR "${binary} has a path to libraries:\n${output}")
    endif()
endforeach()

must(${CMAKE_COMMAND} -S ${SOURCE}/tests/install -B ${scratch}/build -G Ninja
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${scratch}/prefix)
must(${CMAKE_COMMAND} --build ${scratch}/build)
must(${scratch}/build/example ${SOURCE}/data/blob.off ${scratch}/blob.ply)
string(REGEX MATCHALL "the first is 0\\.[0-9]+, all in [0-9.]+ s\n" lines "${output}")
list(LENGTH lines count)
if(NOT count EQUAL 4)
    message(FATAL_ERROR "the example must print four lines, but printed\n${output}")
endif()
must(${scratch}/prefix/bin/surfelao info ${scratch}/blob.ply)

# the Python module, where it was built
if(PYTHON)
    must(${CMAKE_COMMAND} -E env PYTHONPATH=${scratch}/prefix/lib/python3/dist-packages ${PYTHON} -B -c
        "print(__import__('surfelao').bake([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).occlusion)")
    if(NOT output STREQUAL "[0. 0. 0.]\n")
        message(FATAL_ERROR "a lone triangle must be open, but Python printed\n${output}")
    endif()
endif()

# a bad setting is one sentence, and no abort (which would not be a number)
execute_process(COMMAND ${scratch}/build/example ${SOURCE}/data/blob.off ${scratch}/blob.ply 9
    RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT result EQUAL 1 OR NOT said STREQUAL "quality of masks must be between -1 and 4\n")
    message(FATAL_ERROR "quality 9 must be refused by a sentence and exit 1: ${result}\n${said}")
endif()
