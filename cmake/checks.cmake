# The tests that read the sources, the shaders and the documents. They are labelled `check`, and `quick` unless they
# take longer; a test whose tool is not installed is skipped.
find_program(SPIRV_VAL NAMES spirv-val REQUIRED)
find_program(SPIRV_CROSS NAMES spirv-cross REQUIRED)
# Debian's own interpreter first, since the package python3-jsonschema belongs to it.
find_program(PYTHON3 NAMES python3 HINTS /usr/bin REQUIRED)
find_program(CLANG_FORMAT NAMES clang-format-14)
find_program(SHELLCHECK NAMES shellcheck)

# candela_check(NAME COMMAND...) adds a test of the sources. The timeout only says that it hangs.
function(candela_check name)
    add_test(NAME ${name} COMMAND ${ARGN} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(${name} PROPERTIES LABELS "check;quick" TIMEOUT 7200 SKIP_REGULAR_EXPRESSION "^skipped: ")
endfunction()

candela_check(layers ${PYTHON3} cmake/checks/layers.py ${CMAKE_SOURCE_DIR})
candela_check(layers_test ${PYTHON3} cmake/checks/layers_test.py)
candela_check(promises ${PYTHON3} cmake/checks/promises.py docs/files.md ${CMAKE_SOURCE_DIR})
candela_check(licences ${PYTHON3} cmake/checks/licences.py ${CMAKE_SOURCE_DIR})
candela_check(mutations ${PYTHON3} tests/mutations/mutate.py --check)
candela_check(setup_test ${PYTHON3} cmake/checks/setup_test.py)
candela_check(workflows_test ${PYTHON3} cmake/checks/workflows_test.py)
candela_check(shaders_alone ${PYTHON3} cmake/checks/shaders_alone.py ${GLSLANG_VALIDATOR} ${CMAKE_SOURCE_DIR})
set_tests_properties(shaders_alone PROPERTIES LABELS check)
candela_check(schema ${PYTHON3} cmake/checks/schema.py scenes tests/references tests/bench/scenes)
candela_check(scene_keys ${PYTHON3} cmake/checks/scene_keys.py)
candela_check(sky ${PYTHON3} cmake/checks/sky.py scenes)

# These need a device, unlike the others.
file(GLOB pages CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/docs/*.md)
candela_check(readme ${PYTHON3} cmake/checks/readme.py $<TARGET_FILE:candela> README.md ${pages})
set_tests_properties(readme PROPERTIES LABELS cli COST 100)  # Long, so it begins early: see tests/labels.cmake.
candela_check(rivals ${PYTHON3} tests/bench/rivals_test.py $<TARGET_FILE:candela>)
set_tests_properties(rivals PROPERTIES LABELS cli RUN_SERIAL TRUE)
candela_check(session ${PYTHON3} tests/session/session_test.py $<TARGET_FILE:render_scene> $<TARGET_FILE:candela>
    scenes)
set_tests_properties(session PROPERTIES LABELS cli)
candela_check(serve ${PYTHON3} tests/python/serve_test.py $<TARGET_FILE:candela>)
candela_check(serve_shared ${PYTHON3} tests/python/shared_test.py $<TARGET_FILE:candela>)
candela_check(python ${PYTHON3} tests/python/python_test.py $<TARGET_FILE:candela>)
candela_check(http ${PYTHON3} tests/python/http_test.py $<TARGET_FILE:candela>)
candela_check(http_limits ${PYTHON3} tests/python/http_limits_test.py $<TARGET_FILE:candela>)
candela_check(python_scenes ${PYTHON3} tests/python/scenes_test.py $<TARGET_FILE:candela>)
candela_check(python_notebooks ${PYTHON3} tests/python/notebook_test.py $<TARGET_FILE:candela>)
set_tests_properties(serve serve_shared python python_scenes python_notebooks http http_limits PROPERTIES LABELS cli)
candela_check(submit ${PYTHON3} tests/slurm/submit_test.py)
candela_check(slurm ${PYTHON3} tests/slurm/slurm_test.py $<TARGET_FILE:candela>)
set_tests_properties(slurm PROPERTIES LABELS cli COST 100)  # Mostly waits.
if(CANDELA_EMBREE)
    candela_check(tracer ${PYTHON3} tests/bench/tracer_test.py $<TARGET_FILE:candela> $<TARGET_FILE:tracer>)
    set_tests_properties(tracer PROPERTIES LABELS cli RUN_SERIAL TRUE)
endif()

get_target_property(spirv candela_render CANDELA_SPIRV)
get_target_property(probe_spirv candela_probe CANDELA_SPIRV)
get_target_property(test_spirv test_support CANDELA_SPIRV)
foreach(file IN LISTS spirv probe_spirv test_spirv)
    cmake_path(GET file STEM name)
    candela_check(spirv_val.${name} ${SPIRV_VAL} --target-env vulkan1.2 ${file})
endforeach()
candela_check(metal ${PYTHON3} cmake/checks/metal.py ${SPIRV_CROSS} ${spirv} ${probe_spirv} ${test_spirv})

# What AMD's compiler makes of the kernels: Mesa's RADV compiles for a chip that is not there, and nothing runs. About
# three seconds a kernel, so those of the older chip and those that read storage buffers, which differ in nothing else,
# are compiled only among the slow tests. The driver is Mesa's own, regardless of the other tests' driver.
find_file(RADV_MANIFEST NAMES radeon_icd.${CMAKE_HOST_SYSTEM_PROCESSOR}.json radeon_icd.json
    PATHS /usr/share/vulkan/icd.d NO_DEFAULT_PATH)
foreach(family IN ITEMS vega10 navi21)
    foreach(buffers IN ITEMS texel storage)
        set(name kernel_bounds.${family}.${buffers})
        candela_check(${name} $<TARGET_FILE:kernel_statistics> scenes/cornell-box.json scenes/showcase.json
            tests/bench/scenes/layers.json tests/bench/scenes/instances.json --scene-buffers ${buffers}
            --bounds tests/bench/kernel_bounds.json)
        set(label slow)
        if(name STREQUAL "kernel_bounds.navi21.texel")
            set(label check)
        endif()
        set_tests_properties(${name} PROPERTIES ENVIRONMENT "RADV_FORCE_FAMILY=${family};\
VK_DRIVER_FILES=${RADV_MANIFEST};VK_ICD_FILENAMES=${RADV_MANIFEST};CANDELA_VALIDATION=1"
            LABELS ${label})
    endforeach()
endforeach()

file(GLOB_RECURSE sources CONFIGURE_DEPENDS
    ${CMAKE_SOURCE_DIR}/host/*.cpp ${CMAKE_SOURCE_DIR}/host/*.h ${CMAKE_SOURCE_DIR}/shaders/*.glsl
    ${CMAKE_SOURCE_DIR}/shaders/*.h ${CMAKE_SOURCE_DIR}/tests/*.cpp ${CMAKE_SOURCE_DIR}/tests/*.glsl
    ${CMAKE_SOURCE_DIR}/tests/*.h)
if(CLANG_FORMAT)
    candela_check(format ${CLANG_FORMAT} --dry-run -Werror ${sources})
else()
    candela_check(format ${CMAKE_COMMAND} -E echo "skipped: clang-format 14 is not here")
endif()

file(GLOB_RECURSE scripts CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/.ci/*
    ${CMAKE_SOURCE_DIR}/cmake/*.sh ${CMAKE_SOURCE_DIR}/integrations/*.sh ${CMAKE_SOURCE_DIR}/integrations/*.sbatch
    ${CMAKE_SOURCE_DIR}/scenes/*.sh ${CMAKE_SOURCE_DIR}/tests/*.sh)
set(shellcheck_version)
if(SHELLCHECK)
    execute_process(COMMAND ${SHELLCHECK} --version OUTPUT_VARIABLE shellcheck_version)
endif()
if(shellcheck_version MATCHES "version: 0\\.9\\.")
    candela_check(shellcheck ${SHELLCHECK} --external-sources ${scripts})
else()
    candela_check(shellcheck ${CMAKE_COMMAND} -E echo "skipped: shellcheck 0.9 is not here; others find other things")
endif()
