# SPDX-License-Identifier: Apache-2.0
# GoogleTest programs of many files, and a ctest test for each file.

set(NATIVE_PROBES ${CMAKE_CURRENT_BINARY_DIR}/native_probes)

# suite_filter(FILE FILTER): a --gtest_filter of the suites whose tests stand in the file, whether
# plain, typed or with parameters. A test begins a line there.
function(suite_filter FILE FILTER)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${FILE})
    file(STRINGS ${FILE} suites REGEX "^(TYPED_)?TEST(_F|_P)?\\(")
    list(TRANSFORM suites REPLACE "^[A-Z_]+\\(([A-Za-z0-9_]+).*" "\\1")
    list(REMOVE_DUPLICATES suites)
    list(TRANSFORM suites REPLACE "(.+)" "\\1.*:\\1/*:*/\\1.*")
    list(JOIN suites ":" filter)
    set(${FILTER} ${filter} PARENT_SCOPE)
endfunction()

# add_file_tests(PROGRAM LABEL PREFIX ENVIRONMENT FILES...): the tests of FILE_test.cpp as the
# ctest test PREFIXFILE_test.
function(add_file_tests PROGRAM LABEL PREFIX ENVIRONMENT)
    foreach(file ${ARGN})
        get_filename_component(stem ${file} NAME_WE)
        suite_filter(${file} filter)
        add_test(NAME ${PREFIX}${stem} COMMAND ${PROGRAM} --gtest_filter=${filter})
        set_tests_properties(${PREFIX}${stem} PROPERTIES LABELS ${LABEL} ENVIRONMENT "${ENVIRONMENT}")
    endforeach()
endfunction()

# Tests that compute much are optimized; others are compiled in half the time. The libraries that they
# test are the program's.
set(OPTIMIZED_PROGRAMS geometry_tests kernel_tests)

# add_test_program(NAME LABEL SOURCES...): a program of the sources; each that ends in _test.cpp is a
# ctest test of its own. NAME_whole fails where a suite is in none of them.
function(add_test_program NAME LABEL)
    add_executable(${NAME} ${ARGN})
    # Test files have helpers of one name, each in a namespace that CMake gives another name in each file.
    set_target_properties(${NAME} PROPERTIES UNITY_BUILD_UNIQUE_ID this_file UNITY_BUILD_BATCH_SIZE 9)
    target_link_libraries(${NAME} PRIVATE mirrorball_print GTest::gtest_main)
    set(level 0)
    if(NAME IN_LIST OPTIMIZED_PROGRAMS)
        set(level 1)
    endif()
    target_compile_options(${NAME} PRIVATE -O${level})
    if(NOT CMAKE_CXX_COMPILER_LAUNCHER MATCHES ccache)  # ccache and precompiled headers do not go together
        get_property(first GLOBAL PROPERTY PRECOMPILED_AT_${level})
        if(first)
            target_precompile_headers(${NAME} REUSE_FROM ${first})
        else()
            target_precompile_headers(${NAME} PRIVATE precompiled.h)
            set_property(GLOBAL PROPERTY PRECOMPILED_AT_${level} ${NAME})
        endif()
    endif()
    target_compile_definitions(${NAME} PRIVATE
        MIRRORBALL_PICTURES_DIR="${CMAKE_CURRENT_SOURCE_DIR}/pictures"
        MIRRORBALL_PROBES_DIR="${NATIVE_PROBES}"
        MIRRORBALL_SCENES_DIR="${CMAKE_SOURCE_DIR}/scenes"
        MIRRORBALL_BAD_SCENES_DIR="${CMAKE_SOURCE_DIR}/tests/scenes_bad"
        $<$<BOOL:${MIRRORBALL_SANITIZE}>:MIRRORBALL_SANITIZED>)
    set(files ${ARGN})
    list(FILTER files INCLUDE REGEX "_test\\.cpp$")
    set_target_properties(${NAME} PROPERTIES TEST_FILES "${files}")
    add_file_tests(${NAME} ${LABEL} "" "" ${files})
    set(filters "")
    foreach(file ${files})
        suite_filter(${file} filter)
        list(APPEND filters ${filter})
    endforeach()
    list(JOIN filters ":" filter)
    add_test(NAME ${NAME}_whole COMMAND ${NAME} --gtest_filter=-${filter})
    set_tests_properties(${NAME}_whole PROPERTIES LABELS ${LABEL}
        PASS_REGULAR_EXPRESSION " 0 tests from 0 test suites ran")
endfunction()

# add_program_again(PROGRAM LABEL PREFIX ENVIRONMENT EXCEPT STEMS...): its tests once more,
# elsewhere.
function(add_program_again PROGRAM LABEL PREFIX ENVIRONMENT)
    get_target_property(files ${PROGRAM} TEST_FILES)
    foreach(stem ${ARGN})
        list(REMOVE_ITEM files ${stem}.cpp)
    endforeach()
    add_file_tests(${PROGRAM} ${LABEL} ${PREFIX} "${ENVIRONMENT}" ${files})
endfunction()
