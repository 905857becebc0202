# The packages that candela is built from (packages.txt says what each is for) and the flags that all targets share.
find_package(Threads REQUIRED)
find_package(glm REQUIRED)
# Debian's Imath names a Python library that is in another package, and wonders about it at length.
set(CMAKE_MESSAGE_LOG_LEVEL NOTICE)
find_package(OpenEXR 3 REQUIRED)
unset(CMAKE_MESSAGE_LOG_LEVEL)
find_package(nlohmann_json 3.10 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tinyobjloader REQUIRED)
if(CANDELA_EMBREE)
    find_package(embree 3 REQUIRED)
endif()
find_program(GLSLANG_VALIDATOR NAMES glslangValidator glslang REQUIRED)
find_path(VOLK_INCLUDE_DIR NAMES volk.c REQUIRED)
find_path(STB_INCLUDE_DIR NAMES stb_image_write.h PATH_SUFFIXES stb REQUIRED)

# Flags of every target of ours. NaN and infinity are data here: no fast-math anywhere; and the compiler must not
# fuse multiply and add where the shaders do not, so that CPU references agree with the device bit for bit.
add_library(candela_flags INTERFACE)
target_compile_options(candela_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -ffp-contract=off $<$<BOOL:${CANDELA_WERROR}>:-Werror>)
target_compile_definitions(candela_flags INTERFACE GLM_FORCE_XYZW_ONLY GLM_FORCE_EXPLICIT_CTOR)
target_include_directories(candela_flags INTERFACE ${CMAKE_SOURCE_DIR}/host ${CMAKE_SOURCE_DIR}/shaders)
target_include_directories(candela_flags SYSTEM INTERFACE ${STB_INCLUDE_DIR} ${VOLK_INCLUDE_DIR})
target_link_libraries(candela_flags INTERFACE Threads::Threads glm::glm)
if(CANDELA_SANITIZE)
    target_compile_options(candela_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
        -fno-omit-frame-pointer)
    target_link_options(candela_flags INTERFACE -fsanitize=address,undefined)
endif()
