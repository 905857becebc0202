# The packages that candela is built from (packages.txt says what each is for) and the flags that all targets share.
if(CANDELA_PORTABLE)
    set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
    set(ZLIB_USE_STATIC_LIBS ON)
endif()
find_package(Threads REQUIRED)
find_package(glm REQUIRED)
# Debian's Imath names a Python library that is in another package, and reports at length that it is missing.
set(CMAKE_MESSAGE_LOG_LEVEL NOTICE)
find_package(OpenEXR 3 REQUIRED)
unset(CMAKE_MESSAGE_LOG_LEVEL)
find_package(PNG 1.6 REQUIRED)
find_package(JPEG REQUIRED)
# candela_find(NAME HEADER): a library that brings no description for CMake, or one that differs between versions.
function(candela_find name header)
    string(TOUPPER ${name} variable)
    find_path(${variable}_INCLUDE_DIR NAMES ${header} REQUIRED)
    find_library(${variable}_LIBRARY NAMES ${name} REQUIRED)
    add_library(${name} INTERFACE)
    target_include_directories(${name} SYSTEM INTERFACE ${${variable}_INCLUDE_DIR})
    target_link_libraries(${name} INTERFACE ${${variable}_LIBRARY})
endfunction()
candela_find(webp webp/decode.h)
candela_find(draco draco/compression/decode.h)
candela_find(meshoptimizer meshoptimizer.h)
set(CANDELA_BASISU ${CMAKE_SOURCE_DIR}/build/basisu CACHE PATH "Where cmake/basisu.sh has put Basis Universal's decoder")
if(EXISTS ${CANDELA_BASISU}/complete)
    enable_language(C)
    file(STRINGS ${CANDELA_BASISU}/VERSION CANDELA_BASISU_TAG REGEX "^tag v")
    string(REPLACE "tag " "" CANDELA_BASISU_TAG "${CANDELA_BASISU_TAG}")
    string(REGEX REPLACE "^v([0-9]+)_" "\\1." CANDELA_BASISU_VERSION "${CANDELA_BASISU_TAG}")
    add_library(basisu STATIC ${CANDELA_BASISU}/transcoder/basisu_transcoder.cpp ${CANDELA_BASISU}/zstd/zstddeclib.c)
    target_include_directories(basisu SYSTEM PUBLIC ${CANDELA_BASISU}/transcoder)
    target_compile_definitions(basisu PUBLIC CANDELA_BASISU)
    # Its assertions would end the program where it can report an error. To RGBA alone.
    target_compile_definitions(basisu PRIVATE NDEBUG BASISD_SUPPORT_DXT1=0 BASISD_SUPPORT_DXT5A=0
        BASISD_SUPPORT_BC7_MODE5=0 BASISD_SUPPORT_PVRTC1=0 BASISD_SUPPORT_PVRTC2=0 BASISD_SUPPORT_ATC=0
        BASISD_SUPPORT_FXT1=0 BASISD_SUPPORT_ETC2_EAC_A8=0 BASISD_SUPPORT_ETC2_EAC_RG11=0
        BASISD_USE_UNALIGNED_WORD_READS=0)
    target_compile_options(basisu PRIVATE -w -fno-strict-aliasing)
    set_target_properties(basisu PROPERTIES UNITY_BUILD OFF)
endif()
find_package(nlohmann_json 3.10 REQUIRED)
find_package(CLI11 REQUIRED)
if(CANDELA_EMBREE)
    find_package(embree 3 REQUIRED)
endif()
# `candela view`.
set(CANDELA_HAS_VIEW FALSE)
if(CANDELA_VIEW)
    find_package(glfw3 3.3 QUIET)
    find_path(IMGUI_INCLUDE_DIR NAMES imgui.h PATH_SUFFIXES imgui)
    find_library(IMGUI_LIBRARY NAMES imgui)
    find_library(STB_LIBRARY NAMES stb)
    if(glfw3_FOUND AND IMGUI_INCLUDE_DIR AND IMGUI_LIBRARY)
        set(CANDELA_HAS_VIEW TRUE)
        # Debian's library has all backends, and the linker uses only those that are called: not the one for Vulkan,
        # whose calls of Vulkan's functions would resolve to volk's variables of the same names. It also needs stb's
        # library; others have what they need of stb inside.
        add_library(imgui INTERFACE)
        target_include_directories(imgui SYSTEM INTERFACE ${IMGUI_INCLUDE_DIR})
        target_link_libraries(imgui INTERFACE ${IMGUI_LIBRARY} $<$<BOOL:${STB_LIBRARY}>:${STB_LIBRARY}>)
    elseif(NOT CANDELA_VIEW STREQUAL "AUTO")
        message(FATAL_ERROR "CANDELA_VIEW needs GLFW and Dear ImGui: install libglfw3-dev and libimgui-dev, or "
            "configure with -DCANDELA_VIEW=OFF")
    endif()
endif()
find_program(GLSLANG_VALIDATOR NAMES glslangValidator glslang REQUIRED)
find_program(SPIRV_OPT NAMES spirv-opt REQUIRED)
find_path(VOLK_INCLUDE_DIR NAMES volk.c REQUIRED)
find_path(STB_INCLUDE_DIR NAMES stb_image.h PATH_SUFFIXES stb REQUIRED)

# Flags of all our targets. NaN and infinity are data here: no fast-math anywhere; and the compiler must not fuse
# multiply and add where the shaders do not, so that CPU references agree with the device bit for bit. Messages name
# files as in the sources, so that a build in another folder has the same bytes.
add_library(candela_flags INTERFACE)
target_compile_options(candela_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -ffp-contract=off -fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=)
string(REGEX MATCH "^[0-9]+" compiler_major "${CMAKE_CXX_COMPILER_VERSION}")
if(CANDELA_WERROR STREQUAL "${CMAKE_CXX_COMPILER_ID}-${compiler_major}")
    target_compile_options(candela_flags INTERFACE -Werror)
endif()
target_compile_definitions(candela_flags INTERFACE GLM_FORCE_XYZW_ONLY GLM_FORCE_EXPLICIT_CTOR
    $<$<BOOL:${WIN32}>:_USE_MATH_DEFINES>)  # For M_PI, which other systems have anyway.
target_include_directories(candela_flags INTERFACE ${CMAKE_SOURCE_DIR}/host ${CMAKE_SOURCE_DIR}/shaders)
target_include_directories(candela_flags SYSTEM INTERFACE ${STB_INCLUDE_DIR} ${VOLK_INCLUDE_DIR})
target_link_libraries(candela_flags INTERFACE Threads::Threads glm::glm)
if(CANDELA_PORTABLE)
    # A driver brings the C++ run-time library that it needs: the two must not see each other.
    if(WIN32)
        target_link_options(candela_flags INTERFACE -static)
    else()
        target_link_options(candela_flags INTERFACE -static-libstdc++ -static-libgcc LINKER:--exclude-libs,ALL)
    endif()
endif()
set(sanitizers)
if(CANDELA_SANITIZE)
    list(APPEND sanitizers -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
    # GCC 12 believes that parts of vectors, variants and std::regex are uninitialised when it instruments them.
    target_compile_options(candela_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    target_link_options(candela_flags INTERFACE -fsanitize=address,undefined)
endif()
if(CANDELA_FUZZ)
    list(APPEND sanitizers -fsanitize=fuzzer-no-link)
endif()
target_compile_options(candela_flags INTERFACE ${sanitizers})
if(TARGET basisu)
    target_compile_options(basisu PRIVATE ${sanitizers})
endif()
