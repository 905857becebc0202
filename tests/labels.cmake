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
# No label: tests that take ten seconds or more, the longest first. CTest begins with them, also where it has not
# measured tests yet, as in a fresh clone: so none runs alone at the end.
set(long_tests render.PrincipledPictureTest.EstimatorsAgree render.TexturedTest.EstimatorsAgree
    cli.FileFaults.EveryCallMayFailInSomeWay cli.SelftestCommand.QuickPassesWithFewerSamples
    render.NormalMapTest.EstimatorsAgree render.SamplerErrorTest.SobolIsNowhereWorseThanIndependent)

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

set(cost 100)
foreach(test IN LISTS long_tests)
    string(REGEX MATCH "^[a-z]+" kind ${test})
    list(FIND ${kind}_tests_TESTS ${test} place)  # CTest, which reads this too, lacks IN_LIST.
    if(place GREATER -1)
        set_tests_properties(${test} PROPERTIES COST ${cost})
        math(EXPR cost "${cost} - 1")
    elseif(${kind}_tests_TESTS)
        message(SEND_ERROR "there is no test ${test}, which is to be among the first")
    endif()
endforeach()
