# SPDX-License-Identifier: Apache-2.0
set(ENV{GIT_CEILING_DIRECTORIES} ${SOURCE_DIR}/..)  # no other repository around a tarball
execute_process(
    COMMAND git -C ${SOURCE_DIR} describe --always --abbrev=12
    OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
# What is in docs is not in the program, and scripts/bench writes there while it measures.
execute_process(
    COMMAND git -C ${SOURCE_DIR} diff --quiet HEAD -- . ":(exclude)docs"
    RESULT_VARIABLE differs OUTPUT_QUIET ERROR_QUIET)
if(NOT revision)
    set(revision unknown)
elseif(differs EQUAL 1)
    string(APPEND revision -dirty)
endif()
set(text "#include \"host/base/version.h\"\n
namespace rt {
const char* const version = \"${VERSION}\";
const char* const git_revision = \"${revision}\";
}  // namespace rt\n")
if(EXISTS ${OUT})
    file(READ ${OUT} old)
endif()
if(NOT "${old}" STREQUAL "${text}")
    file(WRITE ${OUT} "${text}")
endif()
