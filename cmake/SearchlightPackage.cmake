# What is installed, and the Debian package: cmake --build build/release --target package.
include(GNUInstallDirs)
install(TARGETS searchlight RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TARGET searchlight-gui)
  set(resources ${PROJECT_SOURCE_DIR}/apps/gui/resources)
  install(TARGETS searchlight-gui RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(FILES ${resources}/searchlight.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
  install(FILES ${resources}/searchlight.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/searchlight)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian_copyright
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/searchlight RENAME copyright)

# Manual pages, from --help: made when something is installed, so that no build waits for them.
set(man_pages ${PROJECT_BINARY_DIR}/man)
foreach(program searchlight searchlight-gui)
  if(TARGET ${program})
    set(summary "laboratory for BSSRDFs: subsurface scattering models")
    if(program STREQUAL searchlight-gui)
      set(summary "the window of Searchlight")
    endif()
    # An offscreen window asks for no display.
    install(CODE "execute_process(COMMAND ${CMAKE_COMMAND} -E env QT_QPA_PLATFORM=offscreen ${CMAKE_COMMAND}
      \"-DPROGRAM=$<TARGET_FILE:${program}>\" \"-DSUMMARY=${summary}\" -DVERSION=${PROJECT_VERSION}
      \"-DFOLDER=${man_pages}\" -P \"${PROJECT_SOURCE_DIR}/cmake/ManPages.cmake\" COMMAND_ERROR_IS_FATAL ANY)")
    install(FILES ${man_pages}/${program}.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  endif()
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME searchlight)
# Debian wants an address: whoever makes a package for others gives theirs, -DSEARCHLIGHT_PACKAGE_CONTACT="N <a@b>".
set(SEARCHLIGHT_PACKAGE_CONTACT "Searchlight contributors" CACHE STRING "maintainer of the Debian package")
set(CPACK_PACKAGE_CONTACT ${SEARCHLIGHT_PACKAGE_CONTACT})
# What it reads beside ours.
string(TIMESTAMP package_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${PROJECT_BINARY_DIR}/man/changelog "searchlight (${PROJECT_VERSION}) unstable; urgency=medium

  * See CHANGELOG.md.

 -- ${SEARCHLIGHT_PACKAGE_CONTACT}  ${package_date}
")
install(CODE "execute_process(COMMAND gzip -9nkf \"${PROJECT_BINARY_DIR}/man/changelog\" COMMAND_ERROR_IS_FATAL ANY)")
install(FILES ${PROJECT_BINARY_DIR}/man/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/searchlight)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "laboratory for BSSRDFs: subsurface scattering models")
set(CPACK_PACKAGE_DESCRIPTION "Develops, displays, compares and validates models of light in translucent
things: any model with any technique, on one scene, beside a Monte Carlo
reference that carries its own error bar. searchlight is the command line,
searchlight-gui the window.")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What is loaded at run time, which no linker knows: OpenGL on any machine, and fonts.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl1, libgl1-mesa-dri, libopengl0, fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "fonts-inter, fonts-jetbrains-mono")
set(CPACK_STRIP_FILES ON)
include(CPack)
