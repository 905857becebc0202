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
