# SPDX-License-Identifier: Apache-2.0
# gischt_room(NAME SOURCES ... TESTS ... ROOMS ... PRIVATE ... PUBLIC ...)
#   One static library gischt_NAME from SOURCES and, where TESTS are listed, one test program gischt_NAME_test.
#   ROOMS are the rooms that it may include; PUBLIC and PRIVATE are third-party targets.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

add_library(gischt_flags INTERFACE)
target_compile_options(gischt_flags INTERFACE
    -Wall -Wextra -Wshadow -Wconversion
    # No code here reads errno or floating-point traps; saying so lets loops vectorize. Contraction
    # is left to the explicit FMAs of the SIMD kernels, so that results agree between compilers.
    -fno-math-errno -fno-trapping-math -ffp-contract=off)
target_include_directories(gischt_flags INTERFACE ${CMAKE_SOURCE_DIR}/src ${CMAKE_BINARY_DIR}/generated)

if(GISCHT_TESTS)
    enable_testing()
    include(GoogleTest)
endif()

function(gischt_test target)
    cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
    if(NOT GISCHT_TESTS OR NOT ARG_SOURCES)
        return()
    endif()
    add_executable(${target} ${ARG_SOURCES})
    target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES} GTest::gtest_main)
    # Tests named *Long.* are the long validations, run by `scripts/test --all` only.
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 900 TEST_FILTER "-*Long.*")
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 TEST_PREFIX long. TEST_FILTER "*Long.*"
                         PROPERTIES TIMEOUT 7200 LABELS long)
endfunction()

function(gischt_room name)
    cmake_parse_arguments(ARG "" "" "SOURCES;TESTS;ROOMS;PUBLIC;PRIVATE" ${ARGN})
    list(TRANSFORM ARG_ROOMS PREPEND gischt_)
    if(ARG_SOURCES)
        add_library(gischt_${name} STATIC ${ARG_SOURCES})
        target_link_libraries(gischt_${name} PUBLIC gischt_flags ${ARG_ROOMS} ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    else()
        add_library(gischt_${name} INTERFACE)
        target_link_libraries(gischt_${name} INTERFACE gischt_flags ${ARG_ROOMS} ${ARG_PUBLIC})
    endif()
    gischt_test(gischt_${name}_test SOURCES ${ARG_TESTS} LIBRARIES gischt_${name} ${ARG_PRIVATE})
endfunction()
