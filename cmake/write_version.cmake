# SPDX-License-Identifier: Apache-2.0
execute_process(
    COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12
    OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT revision)
    set(revision unknown)
endif()
set(text "#include \"host/version.h\"\n
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
