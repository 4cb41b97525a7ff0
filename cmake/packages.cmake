# Third-party packages, all from Debian. Each is linked by the one folder that uses it.
find_package(Threads REQUIRED)
find_package(glm CONFIG REQUIRED)
find_package(hwy CONFIG REQUIRED)        # Highway: SIMD, one code for every instruction set
find_package(TBB 2021 CONFIG REQUIRED COMPONENTS tbb)
find_package(OpenMesh CONFIG REQUIRED)   # target OpenMeshCore; the package has no version file
find_package(TinyGLTF CONFIG REQUIRED)   # Debian ships it compiled: no implementation macro
find_package(embree 3.13 CONFIG REQUIRED)
find_package(CLI11 2.1 CONFIG REQUIRED)
find_package(nlohmann_json 3.11 CONFIG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(Eigen3 3.4 CONFIG REQUIRED)  # sparse least squares
find_package(nanoflann CONFIG REQUIRED)   # k-d trees over points
find_package(PkgConfig REQUIRED)
find_package(glfw3 3.3 CONFIG REQUIRED)
pkg_check_modules(imgui REQUIRED IMPORTED_TARGET imgui)

# the module is for Debian's own Python, which need not be the first one on the path
if(EXISTS /usr/bin/python3 AND NOT DEFINED Python_EXECUTABLE)
    set(Python_EXECUTABLE /usr/bin/python3)
endif()
set(PYBIND11_FINDPYTHON ON)
find_package(pybind11 2.10 CONFIG QUIET)
