# What `cmake --install` puts in place: headers, one archive and one export file a tier, so that
#
#   find_package(prodomos REQUIRED COMPONENTS query)
#
# looks for the third parties of `query` and the tiers below it alone. Which those are is read off the targets.
include(CMakePackageConfigHelpers)

# The find_dependency() arguments that bring a linked library's target.
function(prodomos_package_of library result)
  if(library MATCHES "^mrpt::(.+)$")
    set(package "mrpt-${CMAKE_MATCH_1}")
  elseif(library MATCHES "^opencv_(.+)$")
    set(package "OpenCV COMPONENTS ${CMAKE_MATCH_1}")
  elseif(library MATCHES "^Boost::(headers|boost)$")
    set(package "Boost")
  elseif(library MATCHES "^Boost::(.+)$")
    set(package "Boost COMPONENTS ${CMAKE_MATCH_1}")
  elseif(library MATCHES "^PkgConfig::(.+)$")
    set(package "pkg-config ${CMAKE_MATCH_1} ${${CMAKE_MATCH_1}_MODULE_NAME}")
  elseif(library MATCHES "^([^:]+)::[^:]+$")
    set(package "${CMAKE_MATCH_1}") # Eigen3::Eigen, SQLite::SQLite3, ZLIB::ZLIB, nlohmann_json::nlohmann_json
    string(REGEX REPLACE "^SQLite$" "SQLite3" package "${package}")
  else()
    set(package "${library}") # yaml-cpp
  endif()
  set(${result} "${package}" PARENT_SCOPE)
endfunction()

# `set(...)` lines of the package's configuration: what a tier needs before its targets can be loaded.
function(prodomos_tier_needs tier result)
  set(tiers "")
  set(packages "")
  get_target_property(type prodomos_${tier} TYPE)
  set(property LINK_LIBRARIES)
  if(type STREQUAL "INTERFACE_LIBRARY")
    set(property INTERFACE_LINK_LIBRARIES)
  endif()
  get_target_property(libraries prodomos_${tier} ${property})
  foreach(library IN LISTS libraries)
    if(library MATCHES "^prodomos::(.+)$")
      list(APPEND tiers ${CMAKE_MATCH_1})
    elseif(library MATCHES "^[A-Za-z]")
      prodomos_package_of(${library} package)
      list(APPEND packages "${package}")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES packages)
  set(${result} "set(prodomos_${tier}_tiers \"${tiers}\")\nset(prodomos_${tier}_packages \"${packages}\")\n"
      PARENT_SCOPE)
endfunction()

set(prodomos_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/prodomos)
get_property(prodomos_tiers GLOBAL PROPERTY PRODOMOS_TIERS)
set(PRODOMOS_NEEDS "")
foreach(tier IN LISTS prodomos_tiers)
  install(TARGETS prodomos_${tier} EXPORT prodomos-${tier} COMPONENT ${tier})
  install(EXPORT prodomos-${tier} NAMESPACE prodomos:: DESTINATION ${prodomos_cmake_dir} COMPONENT ${tier})
  if(IS_DIRECTORY ${PROJECT_SOURCE_DIR}/include/prodomos/${tier})
    install(DIRECTORY include/prodomos/${tier} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/prodomos COMPONENT ${tier})
  endif()
  prodomos_tier_needs(${tier} needs)
  string(APPEND PRODOMOS_NEEDS "${needs}")
endforeach()

configure_package_config_file(cmake/prodomosConfig.cmake.in ${PROJECT_BINARY_DIR}/prodomosConfig.cmake
                              INSTALL_DESTINATION ${prodomos_cmake_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/prodomosConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/prodomosConfig.cmake ${PROJECT_BINARY_DIR}/prodomosConfigVersion.cmake
              cmake/FindOpenCV.cmake
        DESTINATION ${prodomos_cmake_dir} COMPONENT base)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
