# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` and `cpack` put where. The program finds its modules from where it lies itself,
# so that the whole prefix can be moved.
include(GNUInstallDirs)

set(module_folder ${CMAKE_INSTALL_LIBDIR}/mirrorball)
file(RELATIVE_PATH modules_from_program /prefix/${CMAKE_INSTALL_BINDIR} /prefix/${module_folder})
set_source_files_properties(host/base/files.cpp PROPERTIES
    COMPILE_DEFINITIONS "MIRRORBALL_MODULE_DIR=\"${modules_from_program}\"")

install(TARGETS mirrorball RUNTIME)
if(MIRRORBALL_MODULES)
    install(TARGETS mirrorball_exr mirrorball_oiio LIBRARY DESTINATION ${module_folder})
endif()
if(SDL2_FOUND)
    install(TARGETS mirrorball_sdl LIBRARY DESTINATION ${module_folder})
endif()
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/mirrorball)
install(DIRECTORY python/mirrorball DESTINATION ${CMAKE_INSTALL_DATADIR}/mirrorball/python
    PATTERN __pycache__ EXCLUDE PATTERN program EXCLUDE)
install(FILES docs/bench.schema.json docs/compare.schema.json docs/converge.schema.json
    docs/results.schema.json docs/stress.schema.json
    DESTINATION ${CMAKE_INSTALL_DATADIR}/mirrorball/schemas)
install(FILES cmake/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs/images DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)
install(FILES docs/paper.ipynb docs/sliders.ipynb DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)
file(GLOB pages CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR} *.md docs/*.md python/*.md)
list(REMOVE_ITEM pages CHANGELOG.md)
configure_file(cmake/debian_changelog.in changelog.Debian)
install(CODE "
    function(write_text file)
        execute_process(COMMAND \${ARGN} OUTPUT_FILE \"\${texts}/\${file}\" COMMAND_ERROR_IS_FATAL ANY)
    endfunction()
    set(program \"${CMAKE_BINARY_DIR}/mirrorball\")
    set(texts \"${CMAKE_BINARY_DIR}/texts\")
    file(REMOVE_RECURSE \"\${texts}\")
    file(MAKE_DIRECTORY \"\${texts}\")
    foreach(page ${pages})
        get_filename_component(folder \"\${texts}/pages/\${page}\" DIRECTORY)
        file(MAKE_DIRECTORY \"\${folder}\")
        write_text(\"pages/\${page}\" sed -f \"${CMAKE_SOURCE_DIR}/cmake/installed_links.sed\"
            \"${CMAKE_SOURCE_DIR}/\${page}\")
    endforeach()
    write_text(mirrorball.1 \"\${program}\" --man)
    write_text(mirrorball.1.gz gzip -9nc \"\${texts}/mirrorball.1\")
    write_text(changelog.gz gzip -9nc \"${CMAKE_SOURCE_DIR}/CHANGELOG.md\")
    write_text(changelog.Debian.gz gzip -9nc \"${CMAKE_BINARY_DIR}/changelog.Debian\")
    write_text(mirrorball \"\${program}\" --completions bash)
    write_text(_mirrorball \"\${program}\" --completions zsh)
    write_text(mirrorball.fish \"\${program}\" --completions fish)")
set(texts ${CMAKE_BINARY_DIR}/texts)
install(DIRECTORY ${texts}/pages/ DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${texts}/mirrorball.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${texts}/changelog.gz ${texts}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${texts}/mirrorball DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
# Where zsh looks: its packages' folder in /usr, elsewhere that of the site.
install(CODE "set(zsh_folder site-functions)
    if(CMAKE_INSTALL_PREFIX MATCHES \"/usr$\")
        set(zsh_folder vendor-completions)
    endif()")
install(FILES ${texts}/_mirrorball DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/\${zsh_folder})
install(FILES ${texts}/mirrorball.fish
    DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

# A package for Debian 12. Dependencies by hand: OpenEXR, OpenImageIO, SDL and PoCL serve those who use them,
# where dpkg-shlibdeps would ask for the libraries of every module.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT "mirrorball maintainers <maintainers@mirrorball.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "OpenCL ray tracer that measures its own speed and error")
set(CPACK_PACKAGE_DESCRIPTION
    "Renders spheres, cones, triangles and meshes with Phong light,
 mirrors and glass on OpenCL devices and on POSIX threads, bit for bit
 the same, and reports error against run time.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "libc6 (>= 2.36), libgcc-s1, libstdc++6 (>= 12), libfmt9, libpng16-16, zlib1g, ocl-icd-libopencl1 | libopencl1")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libopenexr-3-1-30, libopenimageio2.4, pocl-opencl-icd, python3-matplotlib")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libsdl2-2.0-0")
include(CPack)
