# Read by CTest after it has discovered the tests: labels them beyond their kind. Each program is asked for its tests
# once, so that none is lost between the labels, or run twice.
#
# slow: suites that begin with Slow, and what these names begin with. They run by `ctest --preset slow` alone.
set(slow_render GlossyEstimatorTest PrincipledPictureTest.EstimatorsAgree TexturedTest.EstimatorsAgree
    NormalMapTest.EstimatorsAgree DiffuseTransmissionTest.EstimatorsAgree SamplerErrorTest.SobolIsNowhere
    ScatteringTest.EstimatorsAgree ScatteringTest.ChoicesOfLightsAgree ScatteringTest.RouletteInHaze
    DeepMediumTest.ReflectsWhatChandrasekharSaysTo SharedKernelTest.TheirPictures SharedKernelTest.Others)
# quick: the most telling tests, all together under a minute on two cores; here by what their names begin with.
set(quick_unit ".")
set(quick_vk ".")
set(quick_gpu Math Sampler Warp Records Interaction Traversal LightTest Dielectric BsdfTest.SamplesFollowTheDensity)
set(quick_render FurnaceTest.EveryRay Roulette DirectLightTest.Under SkyFurnaceTest.AnIdealMirror
    EstimatorTest.AgreeOnManyKindsOfLights IdentityTest.AStateThatWentThroughAFile)
set(quick_cli Usage)
# No label: tests that take ten seconds or more, the longest first. CTest begins with them, also where it has not
# measured tests yet, as in a fresh clone: so none runs alone at the end. Not every preset builds all of them.
set(long_tests cli.FileFaults.EveryCallMayFailInSomeWay cli.SelftestCommand.QuickPassesWithFewerSamples
    render.Scenes/IdentityTest.TunedForLavapipeOrNot/Everything
    render.Gallery/InstanceTest.CutScenesHaveTheSamePicture/lemons)

foreach(kind IN ITEMS unit vk gpu render cli)
    set(unmatched ${quick_${kind}})
    set(unmatched_slow ${slow_${kind}})
    foreach(test IN LISTS ${kind}_tests_TESTS)
        set(is_slow FALSE)
        foreach(pattern IN LISTS slow_${kind} ITEMS Slow)
            if(test MATCHES "^${kind}\\.([^.]*/)?${pattern}")
                set(is_slow TRUE)
                if(unmatched_slow)
                    list(REMOVE_ITEM unmatched_slow ${pattern})
                endif()
            endif()
        endforeach()
        if(is_slow)
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
    if(${kind}_tests_TESTS AND unmatched_slow)
        message(SEND_ERROR "no test of ${kind}_tests begins with what is to be slow: ${unmatched_slow}")
    endif()
    if(${kind}_tests_TESTS AND unmatched)
        message(SEND_ERROR "no test of ${kind}_tests begins with what is to be quick: ${unmatched}")
    endif()
endforeach()

set(cost 100)
foreach(test IN LISTS long_tests)
    string(REGEX MATCH "^[a-z]+" kind ${test})
    list(FIND ${kind}_tests_TESTS ${test} place)  # CTest, which reads this too, lacks IN_LIST.
    if(place GREATER -1)
        set_tests_properties(${test} PROPERTIES COST ${cost})
        math(EXPR cost "${cost} - 1")
    endif()
endforeach()
