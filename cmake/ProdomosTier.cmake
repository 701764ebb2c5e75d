# One tier of the house: a library, its public headers under include/prodomos/<tier>, and the tiers it may see.
#
#   prodomos_tier(map SOURCES a.cpp b.cpp USES geometry sensors LIBRARIES SQLite::SQLite3)
#
# USES is public (their headers appear in ours); LIBRARIES are third parties, seen in src/ only.
function(prodomos_tier tier)
  cmake_parse_arguments(arg "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  set(target prodomos_${tier})
  add_library(${target} ${arg_SOURCES})
  add_library(prodomos::${tier} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${tier} VERSION ${PROJECT_VERSION}
                                             SOVERSION ${PROJECT_VERSION_MAJOR})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(
    ${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                     $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
              PRIVATE ${PROJECT_SOURCE_DIR}/src)
  foreach(lower IN LISTS arg_USES)
    target_link_libraries(${target} PUBLIC prodomos::${lower})
  endforeach()
  target_link_libraries(${target} PRIVATE ${arg_LIBRARIES})
  prodomos_warnings(${target})
  install(TARGETS ${target} EXPORT prodomosTargets COMPONENT ${tier})
endfunction()

# The warnings that every translation unit of ours is held to.
function(prodomos_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion $<$<BOOL:${PRODOMOS_WERROR}>:-Werror>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict) # false alarms on std::string, GCC bug 105651
  endif()
endfunction()

if(PRODOMOS_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
