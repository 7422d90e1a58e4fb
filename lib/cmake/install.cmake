# What cmake --install puts down: both libraries with their headers, the package files that
# find_package(leeway) reads, and the program where it was built. The simulators stay at home.
include(CMakePackageConfigHelpers)

install(TARGETS leeway_core leeway_filters EXPORT leewayTargets)
if(TARGET leeway_program)
  install(TARGETS leeway_program)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/leeway TYPE INCLUDE
  FILES_MATCHING PATTERN "*.hpp"
  PATTERN sim EXCLUDE
  PATTERN studies.hpp EXCLUDE)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/leeway)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/leewayConfig.cmake.in
  ${PROJECT_BINARY_DIR}/leewayConfig.cmake INSTALL_DESTINATION ${package_dir})
# Below 1.0 a new minor version may break what uses it.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/leewayConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(EXPORT leewayTargets NAMESPACE leeway:: DESTINATION ${package_dir})
install(FILES
  ${PROJECT_BINARY_DIR}/leewayConfig.cmake
  ${PROJECT_BINARY_DIR}/leewayConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/FindGeographicLib.cmake
  DESTINATION ${package_dir})
