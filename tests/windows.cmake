# The unit tests for Windows, which cmake/try_windows.sh runs under Wine: all but those that call POSIX themselves, need a
# program of ours, or compare with another reader. The command line is tested by the program of Linux.
file(GLOB_RECURSE sources CONFIGURE_DEPENDS unit/*_test.cpp)
file(GLOB support CONFIGURE_DEPENDS support/*.cpp)
foreach(source IN LISTS sources support)
    file(STRINGS ${source} elsewhere REGEX
        "#include (<(unistd|fcntl|spawn|dlfcn|sys/|tiny_|sanitizer/)|\"(fuzz/|support/process))|::setenv")
    if(elsewhere)
        message(STATUS "Not for Windows: ${source}")
        list(REMOVE_ITEM sources ${source})
        list(REMOVE_ITEM support ${source})
    endif()
endforeach()
add_library(test_support STATIC ${support})
target_link_libraries(test_support PUBLIC candela_cli kernel_bounds draco meshoptimizer GTest::gtest_main)
target_include_directories(test_support PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_definitions(test_support PUBLIC CANDELA_SCENES="${CMAKE_SOURCE_DIR}/scenes"
    CANDELA_CORPORA="${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpora"
    CANDELA_TANGENTS="${CMAKE_CURRENT_SOURCE_DIR}/unit/scene/tangents" $<$<BOOL:${CANDELA_HAS_VIEW}>:CANDELA_VIEW>
    $<$<TARGET_EXISTS:basisu>:CANDELA_BASISU_FILES="${CANDELA_BASISU}/fixtures">)
target_compile_options(test_support PUBLIC ${test_flags})
add_executable(unit_tests ${sources})
target_link_libraries(unit_tests PRIVATE test_support $<$<BOOL:${CANDELA_HAS_VIEW}>:imgui>)
target_precompile_headers(unit_tests PRIVATE ${test_headers})
