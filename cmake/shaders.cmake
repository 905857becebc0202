# candela_add_kernels(TARGET KERNEL.comp.glsl...) compiles kernels to SPIR-V with glslang, with exact dependencies, and
# adds to TARGET one generated source per kernel that holds the words; our headers declare them.
function(candela_add_kernels target)
    foreach(source IN LISTS ARGN)
        get_filename_component(path ${source} ABSOLUTE)
        get_filename_component(name ${source} NAME)
        string(REPLACE ".comp.glsl" "" name ${name})
        set(output ${CMAKE_CURRENT_BINARY_DIR}/kernels/${name})
        add_custom_command(
            OUTPUT ${output}.spv ${output}.cpp
            COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_CURRENT_BINARY_DIR}/kernels
            COMMAND ${GLSLANG_VALIDATOR} --quiet -S comp --target-env vulkan1.2 -I${CMAKE_SOURCE_DIR}/shaders
                    --depfile ${output}.d -o ${output}.spv ${path}
            COMMAND ${CMAKE_COMMAND} -DINPUT=${output}.spv -DOUTPUT=${output}.cpp -DNAME=${name}
                    -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
            DEPENDS ${path} ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
            DEPFILE ${output}.d
            COMMENT "Compiling kernel ${name}"
            VERBATIM)
        target_sources(${target} PRIVATE ${output}.cpp)
        set_source_files_properties(${output}.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
        set_property(TARGET ${target} APPEND PROPERTY CANDELA_SPIRV ${output}.spv)
    endforeach()
endfunction()

# Passes of spirv-opt that inline functions and split structures, as lavapipe would at each start, two to three times as
# slowly. None of them changes the order of operations on numbers, and so none changes a bit of an image. Without
# ssa-rewrite: lavapipe's code for its results is up to 25 % slower.
set(SPIRV_INLINING --merge-return --inline-entry-points-exhaustive --scalar-replacement=0 --convert-local-access-chains
    --eliminate-local-single-block --eliminate-local-single-store --eliminate-dead-code-aggressive)

# candela_inline_kernels(TARGET NAME...) adds to TARGET the kernel NAME_inlined for each of its kernels NAME.
function(candela_inline_kernels target)
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/kernels)
    foreach(name IN LISTS ARGN)
        set(output ${folder}/${name}_inlined)
        add_custom_command(
            OUTPUT ${output}.spv ${output}.cpp
            COMMAND ${SPIRV_OPT} --target-env=vulkan1.2 ${SPIRV_INLINING} ${folder}/${name}.spv -o ${output}.spv
            COMMAND ${CMAKE_COMMAND} -DINPUT=${output}.spv -DOUTPUT=${output}.cpp -DNAME=${name}_inlined
                    -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
            DEPENDS ${folder}/${name}.spv ${CMAKE_SOURCE_DIR}/cmake/embed.cmake ${CMAKE_SOURCE_DIR}/cmake/shaders.cmake
            COMMENT "Inlining kernel ${name}"
            VERBATIM)
        target_sources(${target} PRIVATE ${output}.cpp)
        set_source_files_properties(${output}.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
        set_property(TARGET ${target} APPEND PROPERTY CANDELA_SPIRV ${output}.spv)
    endforeach()
endfunction()

# candela_embed_files(TARGET FILE...) adds to TARGET one generated source per file that holds its bytes; NAME.EXT
# becomes candela::embedded::NAME_EXT, which one of our headers must declare.
function(candela_embed_files target)
    foreach(file IN LISTS ARGN)
        get_filename_component(name ${file} NAME)
        string(MAKE_C_IDENTIFIER ${name} symbol)
        set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded/${symbol}.cpp)
        add_custom_command(
            OUTPUT ${output}
            COMMAND ${CMAKE_COMMAND} -DINPUT=${file} -DOUTPUT=${output} -DNAME=${symbol}
                    -P ${CMAKE_SOURCE_DIR}/cmake/embed_file.cmake
            DEPENDS ${file} ${CMAKE_SOURCE_DIR}/cmake/embed_file.cmake
            COMMENT "Embedding ${name}"
            VERBATIM)
        target_sources(${target} PRIVATE ${output})
        set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endforeach()
endfunction()
