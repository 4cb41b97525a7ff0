# build_facts(target): what bake/build_facts.h tells becomes part of the target. Versions of the
# libraries are those found when configuring; the commit is asked for at every build, and only where
# it has changed is anything compiled.
#
# The same file, run at build time by `cmake -P`, asks for the commit.
if(CMAKE_SCRIPT_MODE_FILE)
    set(commit "")
    execute_process(COMMAND git -C ${SOURCE} rev-parse --show-prefix RESULT_VARIABLE no_checkout
        OUTPUT_VARIABLE prefix OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(no_checkout EQUAL 0 AND prefix STREQUAL "")  # else a copy within something else's checkout
        execute_process(COMMAND git -C ${SOURCE} describe --always --tags --dirty --abbrev=10
            OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    endif()
    set(text "#define SURFELAO_COMMIT \"${commit}\"\n")
    set(old "")
    if(EXISTS ${OUTPUT})
        file(READ ${OUTPUT} old)
    endif()
    if(NOT text STREQUAL old)
        file(WRITE ${OUTPUT} "${text}")
    endif()
    return()
endif()

set(SURFELAO_BUILD_FACTS_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
function(build_facts target)
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/build_facts)
    add_custom_target(source_commit BYPRODUCTS ${folder}/source_commit.h COMMENT ""
        COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DOUTPUT=${folder}/source_commit.h
            -P ${SURFELAO_BUILD_FACTS_SCRIPT}
        VERBATIM)
    add_dependencies(${target} source_commit)

    # OpenMesh's package tells no version; its header does: 0x90000
    find_file(SURFELAO_OPENMESH_HEADER OpenMesh/Core/System/config.h REQUIRED)
    mark_as_advanced(SURFELAO_OPENMESH_HEADER)
    file(STRINGS ${SURFELAO_OPENMESH_HEADER} line REGEX "^#define OM_VERSION 0x")
    string(REGEX REPLACE ".*0x(.)(..)(..)$" "\\1.\\2.\\3" OpenMesh_VERSION "${line}")
    string(REGEX REPLACE "\\.0([0-9])" ".\\1" OpenMesh_VERSION "${OpenMesh_VERSION}")
    set(rows "")
    foreach(library IN ITEMS Embree:embree OpenMesh:OpenMesh tinygltf:TinyGLTF
            OpenImageIO:OpenImageIO TBB:TBB GLM:glm Eigen:Eigen3 Highway:hwy GLFW:glfw3
            "Dear ImGui:imgui" CLI11:CLI11)
        string(REGEX MATCH "^([^:]*):(.*)" unused ${library})
        string(APPEND rows "    {\"${CMAKE_MATCH_1}\", \"${${CMAKE_MATCH_2}_VERSION}\"},\n")
    endforeach()
    file(CONFIGURE OUTPUT ${folder}/libraries.inc CONTENT "${rows}")

    set_source_files_properties(build_facts.cpp PROPERTIES
        SKIP_UNITY_BUILD_INCLUSION ON
        INCLUDE_DIRECTORIES ${folder}
        COMPILE_DEFINITIONS "SURFELAO_VERSION=\"${PROJECT_VERSION}\";SURFELAO_BUILD_TYPE=\"${CMAKE_BUILD_TYPE}\";SURFELAO_COMPILER=\"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\""
        OBJECT_DEPENDS ${folder}/source_commit.h)
endfunction()
