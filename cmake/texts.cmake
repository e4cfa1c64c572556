# SPDX-License-Identifier: Apache-2.0
# embed_text(NAME FILE): adds a C++ source to the library mirrorball_texts that defines
# `const char* const rt::NAME`: the text of FILE; of OpenCL C, with its includes.
add_executable(embed_kernels ${CMAKE_CURRENT_LIST_DIR}/embed_kernels.cpp)
add_library(mirrorball_texts STATIC)

function(embed_text NAME FILE)
    file(GLOB_RECURSE kernel_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/kernels/*)
    set(out ${CMAKE_BINARY_DIR}/${NAME}.cpp)
    add_custom_command(
        OUTPUT ${out}
        COMMAND embed_kernels ${CMAKE_SOURCE_DIR} ${FILE} ${out} ${NAME}
        DEPENDS embed_kernels ${kernel_files} ${CMAKE_SOURCE_DIR}/${FILE}
        COMMENT "Embedding ${FILE}")
    target_sources(mirrorball_texts PRIVATE ${out})
endfunction()
