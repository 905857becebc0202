# candela_add_kernels(TARGET KERNEL.comp.glsl...) compiles kernels to SPIR-V with glslang, exact dependencies
# included, and adds to TARGET one generated source per kernel that holds the words; `embedded_kernels.h` declares
# them. Every kernel is compiled twice: NAME reads the scene through texel buffers, NAME_storage through storage buffers.
function(candela_add_kernels target)
    foreach(source IN LISTS ARGN)
        get_filename_component(path ${source} ABSOLUTE)
        get_filename_component(name ${source} NAME)
        string(REPLACE ".comp.glsl" "" name ${name})
        foreach(access IN ITEMS TEXEL STORAGE)
            if(access STREQUAL "TEXEL")
                set(symbol ${name})
            else()
                set(symbol ${name}_storage)
            endif()
            set(output ${CMAKE_CURRENT_BINARY_DIR}/kernels/${symbol})
            add_custom_command(
                OUTPUT ${output}.spv ${output}.cpp
                COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_CURRENT_BINARY_DIR}/kernels
                COMMAND ${GLSLANG_VALIDATOR} --quiet -S comp --target-env vulkan1.2 -DSCENE_ACCESS_${access}=1
                        -I${CMAKE_SOURCE_DIR}/shaders --depfile ${output}.d -o ${output}.spv ${path}
                COMMAND ${CMAKE_COMMAND} -DINPUT=${output}.spv -DOUTPUT=${output}.cpp -DNAME=${symbol}
                        -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
                DEPENDS ${path} ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
                DEPFILE ${output}.d
                COMMENT "Compiling kernel ${symbol}"
                VERBATIM)
            target_sources(${target} PRIVATE ${output}.cpp)
            set_property(TARGET ${target} APPEND PROPERTY CANDELA_SPIRV ${output}.spv)
        endforeach()
    endforeach()
endfunction()

# candela_embed_files(TARGET FILE...) adds to TARGET one generated source per file that holds its bytes; NAME.EXT is
# candela::embedded::NAME_EXT, which a header of ours must declare.
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
    endforeach()
endfunction()
