# SPDX-License-Identifier: Apache-2.0
# embed_kernels(ENTRY NAME [FURTHER_DEPENDENCY...]): makes a C++ source that defines
# `const char* const rt::NAME`, the OpenCL C text of ENTRY with its includes, and puts its path into
# NAME_SOURCE. An ENTRY that is not .cl is embedded as it stands.
add_executable(embed_kernels ${CMAKE_CURRENT_LIST_DIR}/embed_kernels.cpp)

function(embed_kernels ENTRY NAME)
    file(GLOB_RECURSE kernel_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/kernels/*)
    set(out ${CMAKE_BINARY_DIR}/${NAME}.cpp)
    add_custom_command(
        OUTPUT ${out}
        COMMAND embed_kernels ${CMAKE_SOURCE_DIR} ${ENTRY} ${out} ${NAME}
        DEPENDS embed_kernels ${kernel_files} ${CMAKE_SOURCE_DIR}/${ENTRY} ${ARGN}
        COMMENT "Embedding ${ENTRY}")
    set(${NAME}_SOURCE ${out} PARENT_SCOPE)
endfunction()
