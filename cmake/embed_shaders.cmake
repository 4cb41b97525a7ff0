# embed_shaders(target FILES...): makes the GLSL files part of the target, so that the program needs
# no files beside it. gpu/shader_source.h finds them by file name.
#
# The table of the mask engine's constants, tree/masks/constants.inc, becomes one of them:
# mask_constants.glsl, a `const` for each row whose type GLSL has.
#
# The same file, run at build time by `cmake -P`, writes the C++ table.
if(CMAKE_SCRIPT_MODE_FILE)
    # a row's line as one of GLSL; empty where GLSL has no such type
    function(glsl_constant row result)
        set(text "")
        if(row MATCHES "^SURFELAO_MASK_FLAG\\((k[A-Za-z0-9]+), ([^)]+)\\)")
            set(text "const uint ${CMAKE_MATCH_1} = ${CMAKE_MATCH_2};\n")
        elseif(row MATCHES "^SURFELAO_MASK_CONSTANT\\((float|int), (k[A-Za-z0-9]+), ([^)]+)\\)")
            set(text "const ${CMAKE_MATCH_1} ${CMAKE_MATCH_2} = ${CMAKE_MATCH_3};\n")
            string(REGEX REPLACE "f;" ";" text "${text}")
        endif()
        set(${result} "${text}" PARENT_SCOPE)
    endfunction()

    string(REPLACE "|" ";" FILES "${FILES}")
    set(text "// made from shaders/ by cmake/embed_shaders.cmake\n")
    string(APPEND text "#include \"gpu/shader_source.h\"\n\nnamespace surfelao {\nnamespace {\n")
    string(APPEND text "constexpr ShaderFile kFiles[] = {\n")
    foreach(file IN LISTS FILES)
        cmake_path(GET file FILENAME name)
        if(name STREQUAL "constants.inc")
            set(name mask_constants.glsl)
            set(source "// mask_constants.glsl: made of tree/masks/constants.inc\n")
            file(STRINGS ${file} rows REGEX "^SURFELAO_MASK_")
            foreach(row IN LISTS rows)
                glsl_constant("${row}" line)
                string(APPEND source "${line}")
            endforeach()
        else()
            file(READ ${file} source)
        endif()
        string(APPEND text "    {\"${name}\", R\"glsl(${source})glsl\"},\n")
    endforeach()
    string(APPEND text "};\n}  // namespace\n\n")
    string(APPEND text "std::span<const ShaderFile> shader_files() { return kFiles; }\n}  // namespace surfelao\n")
    file(WRITE ${OUTPUT} "${text}")
    return()
endif()

set(SURFELAO_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
function(embed_shaders target)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_shaders.cpp)
    list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/shaders/ OUTPUT_VARIABLE files)
    list(APPEND files ${PROJECT_SOURCE_DIR}/tree/masks/constants.inc)
    string(REPLACE ";" "|" file_list "${files}")
    add_custom_command(OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} "-DFILES=${file_list}" -DOUTPUT=${output} -P ${SURFELAO_EMBED_SCRIPT}
        DEPENDS ${files} ${SURFELAO_EMBED_SCRIPT}
        VERBATIM)
    target_sources(${target} PRIVATE ${output})
endfunction()
