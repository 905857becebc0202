# Read by CTest after it has discovered the tests: labels them beyond their kind. Each program is asked for its tests
# once, so that none is lost between the labels, or run twice.
#
# slow: suites that begin with Slow. They run by `ctest --preset slow` alone.
# quick: the most telling tests, all together under a minute on two cores; here by what their names begin with.
set(quick_unit ".")
set(quick_vk ".")
set(quick_gpu Math Sampler Warp Records Interaction Traversal LightTest Dielectric BsdfTest.SamplesFollowTheDensity)
set(quick_render FurnaceTest.EveryRay Roulette DirectLightTest.Under SkyFurnaceTest.AnIdealMirror
    EstimatorTest.AgreeOnManyKindsOfLights IdentityTest.AStateThatWentThroughAFile)
set(quick_cli Usage)

foreach(kind IN ITEMS unit vk gpu render cli)
    set(unmatched ${quick_${kind}})
    foreach(test IN LISTS ${kind}_tests_TESTS)
        if(test MATCHES "^${kind}\\.([^.]*/)?Slow")
            set_tests_properties(${test} PROPERTIES LABELS slow)
            continue()
        endif()
        foreach(pattern IN LISTS quick_${kind})
            if(test MATCHES "^${kind}\\.([^.]*/)?${pattern}")
                set_tests_properties(${test} PROPERTIES LABELS quick)
                list(REMOVE_ITEM unmatched ${pattern})
                break()
            endif()
        endforeach()
    endforeach()
    if(${kind}_tests_TESTS AND unmatched)
        message(SEND_ERROR "no test of ${kind}_tests begins with what is to be quick: ${unmatched}")
    endif()
endforeach()
