# Read by cpack for each kind of package: what a package of Debian has that an archive has not.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
    return()
endif()
list(GET CPACK_INSTALL_CMAKE_PROJECTS 0 build)
set(CPACK_INSTALL_CMAKE_PROJECTS "${build};candela;debian;/")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# volk loads Vulkan at run time, so that no library names it.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libvulkan1 (>= 1.2)")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "path tracer that gives the same picture on any Vulkan device")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "candela renders glTF, OBJ, PLY and scenes of its own by path tracing, on
any Vulkan device: a GPU of any vendor, or a CPU. It denoises, tells objects
apart for masks and compositing, renders animations and sets of views by the
thousand, and shows the picture in a window while it accumulates.")
