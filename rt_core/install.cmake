# cmake --install, find_package(palpate COMPONENTS core host) and add_subdirectory: docs/library.md.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

add_library(palpate::core ALIAS rt_core)
add_library(palpate::host ALIAS palpate_host)
set_target_properties(palpate_compiler PROPERTIES EXPORT_NAME compiler)
set_target_properties(rt_core PROPERTIES EXPORT_NAME core OUTPUT_NAME palpate_core)
foreach(name hal record config host)
  set_target_properties(palpate_${name} PROPERTIES EXPORT_NAME ${name})
endforeach()

# What a project that takes this one in installs is its own business.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
set(palpate_package ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
install(TARGETS palpate_compiler rt_core EXPORT palpate_core ARCHIVE COMPONENT core)
install(TARGETS palpate_hal palpate_record palpate_config palpate_host EXPORT palpate_host ARCHIVE COMPONENT host)
install(TARGETS palpate palpate-rt palpate-device RUNTIME COMPONENT programs)
set(palpate_helped palpate)
foreach(program palpate-mesh palpate-view)
  if(TARGET ${program})
    list(APPEND palpate_helped ${program})
  endif()
endforeach()
if(TARGET palpate-mesh)
  install(TARGETS palpate-mesh RUNTIME COMPONENT programs)
endif()
if(TARGET palpate-view)
  install(TARGETS palpate-view RUNTIME COMPONENT viewer)
endif()
# What bash completes, from the help of the programs as they were built.
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/palpate.bash
  COMMAND ${PROJECT_SOURCE_DIR}/sim_host/completion.sh $<TARGET_FILE:palpate> > ${PROJECT_BINARY_DIR}/palpate.bash
  DEPENDS ${palpate_helped} sim_host/completion.sh VERBATIM)
add_custom_target(completion ALL DEPENDS ${PROJECT_BINARY_DIR}/palpate.bash)
# Manual pages, from the same help.
set(palpate_manual ${PROJECT_BINARY_DIR}/manual)
add_custom_command(OUTPUT ${palpate_manual}/palpate.1
  COMMAND ${PROJECT_SOURCE_DIR}/sim_host/manual.sh $<TARGET_FILE:palpate> ${PROJECT_VERSION} ${palpate_manual}
  DEPENDS ${palpate_helped} palpate-rt palpate-device sim_host/manual.sh VERBATIM)
add_custom_target(manual ALL DEPENDS ${palpate_manual}/palpate.1)
install(DIRECTORY ${palpate_manual}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT programs PATTERN palpate-view.1 EXCLUDE)
if(TARGET palpate-view)
  install(FILES ${palpate_manual}/palpate-view.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT viewer)
endif()
install(FILES ${PROJECT_BINARY_DIR}/palpate.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME palpate
  COMPONENT programs)
install(DIRECTORY config/scenes config/devices DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate/config COMPONENT programs)
install(PROGRAMS docs/examples/device.py docs/examples/device_kit.py DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate/examples
  COMPONENT programs)
install(FILES docs/palpate.dbc docs/odrive.dbc DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate COMPONENT programs)
install(FILES docs/examples/device.c docs/examples/organ.toml sim_host/python/palpate_wire.py DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate/examples COMPONENT programs)
install(DIRECTORY rt_core DESTINATION include/palpate COMPONENT core FILES_MATCHING PATTERN "*.h")
install(DIRECTORY hal config sim_host DESTINATION include/palpate COMPONENT host FILES_MATCHING PATTERN "*.h")
foreach(component core host)
  install(EXPORT palpate_${component} NAMESPACE palpate:: DESTINATION ${palpate_package} COMPONENT ${component})
endforeach()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/palpate-config.cmake.in ${PROJECT_BINARY_DIR}/palpate-config.cmake
  INSTALL_DESTINATION ${palpate_package})
# Before 1.0 a minor version may break.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/palpate-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/palpate-config.cmake ${PROJECT_BINARY_DIR}/palpate-config-version.cmake
  DESTINATION ${palpate_package} COMPONENT core)
if(TARGET palpate_python)
  install(TARGETS palpate_python DESTINATION ${PALPATE_PYTHON_DIR}/palpate COMPONENT python)
  install(FILES ${python_package_files} DESTINATION ${PALPATE_PYTHON_DIR}/palpate COMPONENT python)
endif()
include(${PROJECT_SOURCE_DIR}/sim_host/debian/package.cmake)
