# SPDX-License-Identifier: Apache-2.0
# add_fuzz_target(NAME LIBRARY SEEDS...): a libFuzzer program with a short run as its test; a long one is
# scripts/fuzz. Findings and new inputs stay in the build folder.
function(add_fuzz_target NAME LIBRARY)
    add_executable(${NAME} ${NAME}.cpp)
    target_compile_options(${NAME} PRIVATE -fsanitize=fuzzer-no-link)
    target_link_options(${NAME} PRIVATE -fsanitize=fuzzer)
    target_link_libraries(${NAME} PRIVATE ${LIBRARY})
    set(corpus ${CMAKE_BINARY_DIR}/corpus/${NAME})
    file(MAKE_DIRECTORY ${corpus})
    add_test(NAME ${NAME} COMMAND ${NAME} -seed=1 -max_total_time=3 -timeout=100 -rss_limit_mb=4096
        ${corpus} ${ARGN})
    set_tests_properties(${NAME} PROPERTIES LABELS fuzz)
    add_dependencies(fuzz_targets ${NAME})
endfunction()

add_custom_target(fuzz_targets)
add_fuzz_target(fuzz_json_scene mirrorball_threads
    ${CMAKE_SOURCE_DIR}/scenes ${CMAKE_SOURCE_DIR}/tests/scenes_bad)
foreach(model obj ply)
    add_fuzz_target(fuzz_${model}_scene mirrorball_threads
        ${CMAKE_SOURCE_DIR}/tests/models ${CMAKE_SOURCE_DIR}/tests/scenes_bad
        ${CMAKE_SOURCE_DIR}/tests/scenes_blemished)
endforeach()
add_fuzz_target(fuzz_nff_scene mirrorball_threads
    ${CMAKE_SOURCE_DIR}/tests/scenes_nff ${CMAKE_SOURCE_DIR}/tests/scenes_bad
    ${CMAKE_SOURCE_DIR}/tests/scenes_blemished)
add_fuzz_target(fuzz_png_picture mirrorball_image ${CMAKE_SOURCE_DIR}/tests/pictures)
add_fuzz_target(fuzz_journal mirrorball_journal ${CMAKE_SOURCE_DIR}/tests/journals)
add_fuzz_target(fuzz_exr_picture OpenEXR::OpenEXR ${CMAKE_SOURCE_DIR}/tests/pictures)
target_link_libraries(fuzz_exr_picture PRIVATE OpenEXR::OpenEXRCore)
target_sources(fuzz_exr_picture PRIVATE ${CMAKE_SOURCE_DIR}/host/image/modules/exr_module.cpp)
