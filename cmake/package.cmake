# `cmake --install` puts the program into bin, the shared libraries that it brings along into lib, where its run path
# finds them wherever both are moved, and scenes and integrations into share; `cpack` in the build folder makes an
# archive of that.
#
# Configure with -DCANDELA_VIEW=OFF for that: the libraries of the window system must be the system's own.
#
# For the wheel (pyproject.toml), the component `wheel` has the program alone. With -DCANDELA_PORTABLE=ON, it has all
# libraries but glibc inside (cmake/wheel.sh).
#
# `cpack -G DEB` makes a package of Debian, which uses the system's libraries (the component `debian`): with pages of the
# manual, completions for shells, and what a desktop needs to open scenes. Build it with the window.
#
# Left out of archives are the libraries that every system with a Vulkan driver has: glibc and the C++ run-time library.
# A process should have only one of each, and drivers need the system's.
#
# For Windows (cmake/windows.sh), `cpack` makes a zip, with the program on top and all libraries in it.
if(WIN32)
    set(CMAKE_INSTALL_BINDIR .)
    set(CMAKE_INSTALL_DATADIR .)
    set(CMAKE_INSTALL_DOCDIR doc)
endif()
include(GNUInstallDirs)

if(WIN32)
    install(TARGETS candela RUNTIME)
else()
    set_target_properties(candela PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
    # The old kind of run path, which also applies to the libraries that those libraries need.
    if(NOT APPLE)
        target_link_options(candela PRIVATE LINKER:--disable-new-dtags)
    endif()
    install(TARGETS candela RUNTIME_DEPENDENCY_SET candela_libraries)
    install(RUNTIME_DEPENDENCY_SET candela_libraries
        PRE_EXCLUDE_REGEXES "^ld-linux" "^linux-vdso" "^lib(c|m|dl|rt|pthread|stdc\\+\\+|gcc_s)\\.so")
endif()
install(TARGETS candela RUNTIME DESTINATION . COMPONENT wheel EXCLUDE_FROM_ALL)
if(CANDELA_LICENSES)
    install(DIRECTORY ${CANDELA_LICENSES}/ DESTINATION licenses COMPONENT wheel EXCLUDE_FROM_ALL)
endif()
install(DIRECTORY ${CMAKE_SOURCE_DIR}/scenes ${CMAKE_SOURCE_DIR}/integrations DESTINATION ${CMAKE_INSTALL_DATADIR}/candela
    USE_SOURCE_PERMISSIONS PATTERN __pycache__ EXCLUDE PATTERN build EXCLUDE PATTERN *.egg-info EXCLUDE)
install(FILES ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${CMAKE_SOURCE_DIR}/LICENSE
    DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(CODE "set(version ${PROJECT_VERSION})
set(name candela-${PROJECT_VERSION}-${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR})
set(documents ${CMAKE_INSTALL_DOCDIR})
set(library_folder ${CMAKE_INSTALL_LIBDIR})
set(architecture ${CMAKE_LIBRARY_ARCHITECTURE})
set(windows ${WIN32})
set(built_from_source ${CANDELA_LICENSES})
set(basisu $<$<TARGET_EXISTS:basisu>:${CANDELA_BASISU}>)
set(basisu_tag \"${CANDELA_BASISU_TAG}\")
set(basisu_version \"${CANDELA_BASISU_VERSION}\")")
install(SCRIPT ${CMAKE_SOURCE_DIR}/cmake/archive_files.cmake)

set(CPACK_PACKAGE_CONTACT "The candela contributors <maintainers@candela.invalid>" CACHE STRING
    "Who answers for the package of Debian")

# What only the system's folders are for. The program prints its own manual and completions.
set(desktop ${CMAKE_SOURCE_DIR}/integrations/desktop)
set(share ${CMAKE_CURRENT_BINARY_DIR}/share)
set(to_debian COMPONENT debian EXCLUDE_FROM_ALL)
install(TARGETS candela RUNTIME ${to_debian})
install(CODE "set(candela $<TARGET_FILE:candela>)
set(share ${share})
set(version ${PROJECT_VERSION})
set(contact \"${CPACK_PACKAGE_CONTACT}\")" ${to_debian})
install(SCRIPT ${CMAKE_SOURCE_DIR}/cmake/debian_files.cmake ${to_debian})
install(DIRECTORY ${share}/ DESTINATION ${CMAKE_INSTALL_DATADIR} ${to_debian})
install(DIRECTORY ${CMAKE_SOURCE_DIR}/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/candela ${to_debian}
    PATTERN __pycache__ EXCLUDE)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR} ${to_debian})
install(FILES ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} ${to_debian})
file(READ ${CMAKE_SOURCE_DIR}/LICENSE copyright)
if(TARGET basisu)
    file(READ ${CANDELA_BASISU}/NOTICE notice)
    file(READ ${CANDELA_BASISU}/zstd/LICENSE of_zstandard)
    string(APPEND copyright "\nThe program contains a decoder of textures, under the Apache licence 2.0, which is in "
        "/usr/share/common-licenses/Apache-2.0:\n\n${notice}\nand in it, one of Zstandard:\n\n${of_zstandard}")
endif()
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/copyright "${copyright}")
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} ${to_debian})
install(FILES ${desktop}/candela.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications ${to_debian})
install(FILES ${desktop}/candela.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps ${to_debian})
install(FILES ${desktop}/candela.mime.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages RENAME candela.xml
    ${to_debian})
install(FILES ${desktop}/candela.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo
    RENAME io.github.candela_render.candela.metainfo.xml ${to_debian})

if(WIN32)
    set(CPACK_GENERATOR ZIP)
else()
    set(CPACK_GENERATOR TGZ)
endif()
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "A path tracer that gives the same picture on any Vulkan device")
string(TOLOWER "${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR}" system)
set(CPACK_PACKAGE_FILE_NAME "candela-${PROJECT_VERSION}-${system}")
set(CPACK_STRIP_FILES ON)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_SOURCE_DIR}/cmake/cpack_debian.cmake)
include(CPack)
