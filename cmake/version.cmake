# SPDX-License-Identifier: Apache-2.0
# Writes version.cpp with the project's version and git revision; rewritten only when they change.
add_custom_target(mirrorball_version
    COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${CMAKE_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
            -DOUT=${CMAKE_BINARY_DIR}/version.cpp
            -P ${CMAKE_CURRENT_LIST_DIR}/write_version.cmake
    BYPRODUCTS ${CMAKE_BINARY_DIR}/version.cpp
    COMMENT "Asking git for the revision")
