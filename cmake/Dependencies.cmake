# SPDX-License-Identifier: Apache-2.0
# Every library is a Debian 12 package; scripts/setup installs them.
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(OpenEXR REQUIRED QUIET)
find_package(PNG REQUIRED)
find_package(hwy REQUIRED)
find_package(embree 3.13 REQUIRED)
find_package(assimp REQUIRED)
# Three paths: the baseline of x86-64, AVX2, AVX-512. Those between them cost build time and gain nothing today.
target_compile_definitions(hwy::hwy INTERFACE "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3_DL)")
if(GISCHT_TESTS)
    find_package(GTest REQUIRED)
endif()
if(GISCHT_BENCH)
    find_package(benchmark REQUIRED)
endif()

# OpenVDB's own find module wants Blosc, Boost and Imath details that this door does not need.
add_library(gischt_openvdb INTERFACE)
find_library(OPENVDB_LIBRARY openvdb REQUIRED)
find_path(OPENVDB_INCLUDE openvdb/openvdb.h REQUIRED)
target_include_directories(gischt_openvdb SYSTEM INTERFACE ${OPENVDB_INCLUDE})
target_link_libraries(gischt_openvdb INTERFACE ${OPENVDB_LIBRARY} TBB::tbb Imath::Imath)

# OpenGL through libepoxy, which opens libEGL when it is asked for something of it.
add_library(gischt_epoxy INTERFACE)
find_library(EPOXY_LIBRARY epoxy REQUIRED)
find_path(EPOXY_INCLUDE epoxy/gl.h REQUIRED)
target_include_directories(gischt_epoxy SYSTEM INTERFACE ${EPOXY_INCLUDE})
target_link_libraries(gischt_epoxy INTERFACE ${EPOXY_LIBRARY})

# The window. Debian's Dear ImGui brings its back ends for GLFW and OpenGL 3 along.
if(GISCHT_VIEW)
    find_package(glfw3 3.3 REQUIRED)
    add_library(gischt_imgui INTERFACE)
    find_library(IMGUI_LIBRARY imgui REQUIRED)
    find_library(STB_LIBRARY stb REQUIRED)  # its fonts
    find_path(IMGUI_INCLUDE imgui/imgui.h REQUIRED)
    # Its headers include each other without the folder.
    target_include_directories(gischt_imgui SYSTEM INTERFACE ${IMGUI_INCLUDE} ${IMGUI_INCLUDE}/imgui)
    target_link_libraries(gischt_imgui INTERFACE ${IMGUI_LIBRARY} ${STB_LIBRARY} ${CMAKE_DL_LIBS})
endif()
