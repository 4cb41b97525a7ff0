# `cmake --install`: program, libraries, headers and a CMake package for find_package(surfelao).
include(CMakePackageConfigHelpers)

set(installed surfels files tree reference)
install(TARGETS ${installed} EXPORT surfelao
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/surfelao)
install(EXPORT surfelao NAMESPACE surfelao::
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/surfelao FILE surfelaoTargets.cmake)
configure_package_config_file(cmake/surfelaoConfig.cmake.in surfelaoConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/surfelao)
write_basic_package_version_file(surfelaoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
    ${CMAKE_CURRENT_BINARY_DIR}/surfelaoConfig.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/surfelaoConfigVersion.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/surfelao)
