# Packages are looked for where they are used; what they bring is seen everywhere, because whoever links a static tier
# links that tier's third parties too.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)

# One tier of the house: a library, its public headers under include/prodomos/<tier>, and the tiers it may see.
#
#   prodomos_tier(map SOURCES a.cpp b.cpp USES geometry sensors LIBRARIES SQLite::SQLite3)
#
# USES is public (their headers appear in ours); LIBRARIES are third parties, seen in src/ only.
function(prodomos_tier tier)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;USES;LIBRARIES")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "prodomos_tier(${tier}): unknown arguments ${arg_UNPARSED_ARGUMENTS}")
  endif()
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
  list(TRANSFORM arg_USES PREPEND prodomos::)
  target_link_libraries(${target} PUBLIC ${arg_USES} PRIVATE ${arg_LIBRARIES})
  prodomos_warnings(${target})
  set_property(GLOBAL APPEND PROPERTY PRODOMOS_TIERS ${tier})
endfunction()

# The warnings that every translation unit of ours is held to. Some are off: g++ 12 sees overlaps in plain `"a" + text`
# (-Wrestrict) and uninitialized parts in empty std::optional (-Wmaybe-uninitialized), and designated initializers leave
# out on purpose what keeps its default.
function(prodomos_warnings target)
  target_compile_options(
    ${target} PRIVATE -Wall -Wextra -Wconversion -Wno-missing-field-initializers
                      $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-maybe-uninitialized>
                      $<$<BOOL:${PRODOMOS_WERROR}>:-Werror>)
endfunction()

if(PRODOMOS_SANITIZE)
  # MRPT's classes ask for 32 bytes of alignment, and its library does not give them.
  add_compile_options(-fsanitize=address,undefined -fno-sanitize=alignment -fno-sanitize-recover=all
                      -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
