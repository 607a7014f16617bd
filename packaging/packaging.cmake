# What `cmake --install` and `cpack` hand out: program, library with headers for
# find_package(nuvo), manual page, completion of bash, licences.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

add_executable(nuvo_pages packaging/pages.cpp)
target_link_libraries(nuvo_pages PRIVATE nuvo_lib)
set(NUVO_PAGES ${PROJECT_BINARY_DIR}/pages)
foreach(page IN ITEMS man:nuvo.1 bash:nuvo.bash)
  string(REPLACE ":" ";" page ${page})
  list(GET page 0 kind)
  list(GET page 1 name)
  add_custom_command(OUTPUT ${NUVO_PAGES}/${name} VERBATIM
    COMMAND ${CMAKE_COMMAND} -E make_directory ${NUVO_PAGES}
    COMMAND $<TARGET_FILE:nuvo_pages> ${kind} > ${NUVO_PAGES}/${name} DEPENDS nuvo_pages)
endforeach()
add_custom_target(pages ALL DEPENDS ${NUVO_PAGES}/nuvo.1 ${NUVO_PAGES}/nuvo.bash)

set_target_properties(nuvo_lib PROPERTIES EXPORT_NAME nuvo)
set_target_properties(nuvo PROPERTIES EXPORT_NAME program)
# The headers' own arithmetic keeps its order of operations in others' programs, too.
target_compile_options(nuvo_lib INTERFACE $<INSTALL_INTERFACE:-ffp-contract=off>)
set(NUVO_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/nuvo)
install(TARGETS nuvo nuvo_lib EXPORT nuvo_targets)
install(DIRECTORY include/nuvo DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT nuvo_targets NAMESPACE nuvo:: DESTINATION ${NUVO_CONFIG_DIR} FILE nuvo-targets.cmake)
configure_package_config_file(packaging/nuvo-config.cmake.in nuvo-config.cmake
  INSTALL_DESTINATION ${NUVO_CONFIG_DIR})
write_basic_package_version_file(nuvo-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/nuvo-config.cmake
  ${PROJECT_BINARY_DIR}/nuvo-config-version.cmake DESTINATION ${NUVO_CONFIG_DIR})
install(FILES ${NUVO_PAGES}/nuvo.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${NUVO_PAGES}/nuvo.bash RENAME nuvo
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES LICENSE THIRD_PARTY.md CITATION.cff README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES testfiles/showcase.x3d DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT "the nuvo authors <nuvo@invalid>")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# To link against the library; the program needs none of them.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libboost-chrono-dev, libboost-program-options-dev, libnlopt-cxx-dev, libpng-dev, zlib1g-dev, libgeos-dev, libhwy-dev")
include(CPack)
