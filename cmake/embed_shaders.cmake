# embed_shaders(target FILES...): makes the GLSL files part of the target, so that the program needs
# no files beside it. gpu/shader_source.h finds them by file name.
#
# The same file, run at build time by `cmake -P`, writes the C++ table.
if(CMAKE_SCRIPT_MODE_FILE)
    string(REPLACE "|" ";" FILES "${FILES}")
    set(text "// made from shaders/ by cmake/embed_shaders.cmake\n")
    string(APPEND text "#include \"gpu/shader_source.h\"\n\nnamespace surfelao {\nnamespace {\n")
    string(APPEND text "constexpr ShaderFile kFiles[] = {\n")
    foreach(file IN LISTS FILES)
        file(READ ${file} source)
        cmake_path(GET file FILENAME name)
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
    string(REPLACE ";" "|" file_list "${files}")
    add_custom_command(OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} "-DFILES=${file_list}" -DOUTPUT=${output} -P ${SURFELAO_EMBED_SCRIPT}
        DEPENDS ${files} ${SURFELAO_EMBED_SCRIPT}
        VERBATIM)
    target_sources(${target} PRIVATE ${output})
endfunction()
