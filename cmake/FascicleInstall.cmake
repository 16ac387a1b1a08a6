# Install and export: every library declared by fascicle_library, its headers, the content files and the programs,
# so that `find_package(fascicle)` gives fascicle::muscle and its parts.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY FASCICLE_INSTALL_TARGETS)
set_target_properties(fascicle_flags PROPERTIES EXPORT_NAME flags)
set_target_properties(fascicle_muscle PROPERTIES EXPORT_NAME muscle)
install(TARGETS fascicle_flags fascicle_muscle ${libraries} EXPORT fascicle-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY engine modules DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/fascicle FILES_MATCHING PATTERN "*.hpp")
# The bones' fields beside a character are a cache of this machine.
install(DIRECTORY content/ DESTINATION ${CMAKE_INSTALL_DATADIR}/fascicle/content PATTERN "*.bones.vdb*" EXCLUDE)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
foreach(program fascicle fascicle-check fascicle-cook fascicle-bench)
  if(TARGET ${program})
    install(TARGETS ${program} DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endforeach()

set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/fascicle)
install(EXPORT fascicle-targets NAMESPACE fascicle:: DESTINATION ${config_dir})
configure_package_config_file(cmake/fascicle-config.cmake.in ${CMAKE_BINARY_DIR}/fascicle-config.cmake
  INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/fascicle-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/fascicle-config.cmake ${CMAKE_BINARY_DIR}/fascicle-config-version.cmake
  cmake/FindDebianOpenVDB.cmake
  DESTINATION ${config_dir})
