# What `cmake --install` puts where, with pkg-config and a CMake package.
include(CMakePackageConfigHelpers)

install(TARGETS jali_static jali_shared EXPORT jali-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(TARGET jali)
  install(TARGETS jali RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET jali_svg)
  install(TARGETS jali_svg LIBRARY DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/jali)
endif()
if(TARGET jali_mpi)
  install(TARGETS jali_mpi RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/jali)
endif()
install(DIRECTORY include/jali DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES printers/schema/printer.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/jali)
install(EXPORT jali-targets NAMESPACE jali:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/jali)
configure_package_config_file(cmake/jali-config.cmake.in ${PROJECT_BINARY_DIR}/jali-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/jali)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/jali-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/jali-config.cmake ${PROJECT_BINARY_DIR}/jali-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/jali)
# The prefix is told from where jali.pc lies, so that an installed tree may be moved.
file(RELATIVE_PATH JALI_PREFIX_FROM_PKGCONFIG /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/jali.pc.in ${PROJECT_BINARY_DIR}/jali.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/jali.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
