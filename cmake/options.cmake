# What every target of ours is compiled with, and nobody else's; and the one way to declare a folder.
add_library(surfelao_options INTERFACE)
target_compile_features(surfelao_options INTERFACE cxx_std_20)
target_compile_options(surfelao_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow
    -ffp-contract=off  # equal results with and without FMA hardware
    $<$<BOOL:${SURFELAO_WERROR}>:-Werror>
    $<$<BOOL:${SURFELAO_SANITIZE}>:-fsanitize=address,undefined;-fno-sanitize-recover=undefined;-fno-omit-frame-pointer>
    $<$<BOOL:${SURFELAO_FUZZ}>:-fsanitize=fuzzer-no-link>
    $<$<BOOL:${SURFELAO_TSAN}>:-fsanitize=thread>)
target_link_options(surfelao_options INTERFACE
    $<$<BOOL:${SURFELAO_SANITIZE}>:-fsanitize=address,undefined>
    $<$<BOOL:${SURFELAO_TSAN}>:-fsanitize=thread>)

# surfelao_folder(name SOURCES ... HEADERS ...): the static library of one folder.
# Includes are written from the top: #include "surfels/scene.h".
function(surfelao_folder name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;HEADERS")
    add_library(${name} STATIC ${arg_SOURCES})
    set_target_properties(${name} PROPERTIES OUTPUT_NAME surfelao_${name})
    target_sources(${name} PUBLIC
        FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${arg_HEADERS})
    target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:surfelao_options>)
    target_compile_features(${name} PUBLIC cxx_std_20)
endfunction()
