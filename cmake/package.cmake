# `cmake --build build/package --target package` (or `./run package`): surfelao_VERSION_ARCH.deb, one
# package with all that `cmake --install` installs. Debian's own rules that need the installed files
# are followed by the same text, run by CPack on them.
if(CPACK_TEMPORARY_DIRECTORY)
    set(root ${CPACK_TEMPORARY_DIRECTORY}/usr)
    file(MAKE_DIRECTORY ${root}/share/lintian/overrides)
    file(COPY_FILE ${CPACK_SURFELAO_PACKAGING}/changelog
        ${root}/share/doc/surfelao/changelog.Debian)
    file(COPY_FILE ${CPACK_SURFELAO_PACKAGING}/lintian-overrides
        ${root}/share/lintian/overrides/surfelao)
    file(GLOB compressed ${root}/share/man/man1/*.1 ${root}/share/doc/surfelao/changelog.Debian)
    execute_process(COMMAND gzip -9n ${compressed} COMMAND_ERROR_IS_FATAL ANY)
    file(GLOB_RECURSE archives ${root}/lib/*.a)  # CPack strips programs and modules alone
    execute_process(COMMAND strip --strip-debug --remove-section=.comment --enable-deterministic-archives
        ${archives} COMMAND_ERROR_IS_FATAL ANY)
    return()
endif()

file(STRINGS packaging/changelog changelog LIMIT_COUNT 1)
if(NOT changelog MATCHES "\\(${PROJECT_VERSION}-([0-9]+)\\)")
    message(FATAL_ERROR "packaging/changelog does not begin with version ${PROJECT_VERSION}")
endif()
set(CPACK_DEBIAN_PACKAGE_RELEASE ${CMAKE_MATCH_1})
file(STRINGS packaging/changelog maintainer REGEX "^ -- " LIMIT_COUNT 1)
string(REGEX REPLACE "^ -- (.*>).*" "\\1" CPACK_DEBIAN_PACKAGE_MAINTAINER "${maintainer}")

set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_FILE})
set(CPACK_SURFELAO_PACKAGING ${PROJECT_SOURCE_DIR}/packaging)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "ambient occlusion and bent normals for meshes")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Ambient occlusion of meshes and point clouds: baked into vertices and
textures, drawn as pictures and in a window. Fast, without noise, and with an
error that is measured against ray tracing in every run.
.
The package holds the program surfelao, its manual pages and completions, the
library with its headers for C++, and where it was built with it, the module
surfelao for Python.")
# opened when first used, so not seen by shlibdeps
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libosmesa6, fonts-dejavu-core")
# to compile against the library
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "libglm-dev, libembree-dev, libhwy-dev, libopenmesh-dev, libtbb-dev, libtinygltf-dev")
if(TARGET python_core)
    get_target_property(suffix python_core SUFFIX)  # .cpython-311-x86_64-linux-gnu.so
    string(REGEX MATCH "cpython-3([0-9]+)" unused "${suffix}")
    math(EXPR next "${CMAKE_MATCH_1} + 1")
    string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS
        ", python3 (>= 3.${CMAKE_MATCH_1}), python3 (<< 3.${next}), python3-numpy")
    set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
        ${PROJECT_SOURCE_DIR}/packaging/postinst ${PROJECT_SOURCE_DIR}/packaging/prerm)
endif()
include(CPack)
