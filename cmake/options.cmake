# What every target of ours is compiled with, and nobody else's; and the one way to declare a folder.
add_library(surfelao_options INTERFACE)
target_compile_features(surfelao_options INTERFACE cxx_std_20)
target_compile_options(surfelao_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow
    -ffp-contract=off  # equal results with and without FMA hardware
    $<$<BOOL:${SURFELAO_WERROR}>:-Werror>
    $<$<BOOL:${SURFELAO_SANITIZE}>:-fsanitize=address,undefined;-fno-sanitize-recover=undefined;-fno-omit-frame-pointer>
    $<$<BOOL:${SURFELAO_TSAN}>:-fsanitize=thread>)
target_link_options(surfelao_options INTERFACE
    $<$<BOOL:${SURFELAO_SANITIZE}>:-fsanitize=address,undefined>
    $<$<BOOL:${SURFELAO_TSAN}>:-fsanitize=thread>)

# surfelao_unity(target): its sources are compiled several to a unit, where SURFELAO_UNITY says so.
# Most of what a compiler reads is the same headers again and again, so this halves the processor
# time. Not for the hot kernels of tree: those stay one unit each. Names in anonymous namespaces must
# differ between the files of one target, or of one UNITY_GROUP.
function(surfelao_unity target)
    set_target_properties(${target} PROPERTIES
        UNITY_BUILD ${SURFELAO_UNITY}
        UNITY_BUILD_BATCH_SIZE 10)  # a unit takes 5 to 15 s; larger ones leave cores idle
    # meant for headers; in a unit every source is one
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# surfelao_fuzzed(target): counts what a fuzzer has reached in it. For what fuzzers look into alone:
# the counters take Clang a quarter of its time, and tests run slower with them.
function(surfelao_fuzzed target)
    target_compile_options(${target} PRIVATE $<$<BOOL:${SURFELAO_FUZZ}>:-fsanitize=fuzzer-no-link;-O1>)
endfunction()

# surfelao_folder(name [UNITY] [FUZZED] SOURCES ... HEADERS ...): the static library of one folder.
# Includes are written from the top: #include "surfels/scene.h".
function(surfelao_folder name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "UNITY;FUZZED" "" "SOURCES;HEADERS")
    add_library(${name} STATIC ${arg_SOURCES})
    set_target_properties(${name} PROPERTIES OUTPUT_NAME surfelao_${name})
    target_sources(${name} PUBLIC
        FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${arg_HEADERS})
    target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:surfelao_options>)
    target_compile_features(${name} PUBLIC cxx_std_20)
    if(arg_UNITY)
        surfelao_unity(${name})
    endif()
    if(arg_FUZZED)
        surfelao_fuzzed(${name})
    endif()
endfunction()
