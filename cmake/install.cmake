# `cmake --install`: the program, and the library as one archive with one target,
# surfelao::surfelao, for find_package(surfelao). Of the headers only those that a user needs:
# surfelao/surfelao.h, the manual, and what it includes.
include(CMakePackageConfigHelpers)

set(bundled surfels files tree reference gpu engines)
add_library(surfelao_library STATIC)
foreach(folder IN LISTS bundled)
    target_sources(surfelao_library PRIVATE $<TARGET_OBJECTS:${folder}>)
endforeach()
set_target_properties(surfelao_library PROPERTIES
    EXPORT_NAME surfelao OUTPUT_NAME surfelao LINKER_LANGUAGE CXX)
target_compile_features(surfelao_library PUBLIC cxx_std_20)
target_link_libraries(surfelao_library
    PUBLIC glm::glm
    PRIVATE embree hwy::hwy OpenMeshCore TBB::tbb Threads::Threads TinyGLTF::TinyGLTF
        ${CMAKE_DL_LIBS})
target_sources(surfelao_library
    PUBLIC FILE_SET manual TYPE HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}
    FILES ${PROJECT_SOURCE_DIR}/surfelao/surfelao.h
    PUBLIC FILE_SET included TYPE HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}
    FILES
        ${PROJECT_SOURCE_DIR}/engines/engine.h
        ${PROJECT_SOURCE_DIR}/engines/threads.h
        ${PROJECT_SOURCE_DIR}/files/scene_io.h
        ${PROJECT_SOURCE_DIR}/files/vertex_colors.h
        ${PROJECT_SOURCE_DIR}/surfels/errors.h
        ${PROJECT_SOURCE_DIR}/surfels/geometry.h
        ${PROJECT_SOURCE_DIR}/surfels/occlusion.h
        ${PROJECT_SOURCE_DIR}/surfels/progress.h
        ${PROJECT_SOURCE_DIR}/surfels/receiver.h
        ${PROJECT_SOURCE_DIR}/surfels/base_colors.h
        ${PROJECT_SOURCE_DIR}/surfels/scene.h
        ${PROJECT_SOURCE_DIR}/surfels/share.h
        ${PROJECT_SOURCE_DIR}/surfels/surface.h)
add_library(surfelao::surfelao ALIAS surfelao_library)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/surfelao)
install(TARGETS surfelao_library EXPORT surfelao
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET manual DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
    FILE_SET included DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/surfelao)
install(EXPORT surfelao NAMESPACE surfelao::
    DESTINATION ${package_folder} FILE surfelaoTargets.cmake)
configure_package_config_file(cmake/surfelaoConfig.cmake.in surfelaoConfig.cmake
    INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(surfelaoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
    ${CMAKE_CURRENT_BINARY_DIR}/surfelaoConfig.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/surfelaoConfigVersion.cmake
    DESTINATION ${package_folder})

# for desktops, and to read
install(FILES packaging/surfelao.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES packaging/surfelao.svg
    DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
install(FILES packaging/surfelao.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages)
install(FILES README.md packaging/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR}
    FILES_MATCHING REGEX "\\.(md|png|jpg|svg)$" PATTERN figures EXCLUDE)
install(FILES tests/install/example.cpp data/blob.off data/blocks.ply data/bracket.obj
    data/leaves.glb data/robot.glb data/room.obj data/shells.stl
    DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples)
