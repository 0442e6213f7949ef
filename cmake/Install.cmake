# cmake --install build --prefix /usr: programs, the cells that come along, the systemd unit and its system user, the
# dashboard, and the documentation. ./package makes Debian packages of the same.
include(GNUInstallDirs)
foreach(program cellmirror sim_robot sim_haptic sim_footswitch sim_camera_head)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endforeach()
# Started by cellmirror, not by people.
foreach(program cellmirror-mesh-reader cellmirror-volume-reader cellmirror-dds cellmirror-mqtt)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/cellmirror)
  endif()
endforeach()
# Not what runs and scripts have left in the tree, nor the scripts that made the meshes.
install(DIRECTORY ${CMAKE_SOURCE_DIR}/config/cells ${CMAKE_SOURCE_DIR}/config/languages
  DESTINATION ${CMAKE_INSTALL_DATADIR}/cellmirror FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ
  PATTERN records EXCLUDE PATTERN __pycache__ EXCLUDE PATTERN "*.py" EXCLUDE PATTERN "*.pyc" EXCLUDE)
install(FILES ${CMAKE_SOURCE_DIR}/config/grafana/cellmirror.json DESTINATION ${CMAKE_INSTALL_DATADIR}/cellmirror/grafana)
install(FILES ${CMAKE_SOURCE_DIR}/config/systemd/cellmirror@.service DESTINATION lib/systemd/system)
install(FILES ${CMAKE_SOURCE_DIR}/config/systemd/cellmirror.sysusers DESTINATION lib/sysusers.d RENAME cellmirror.conf)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/cellmirror-doc
  PATTERN __pycache__ EXCLUDE PATTERN "*.pyc" EXCLUDE)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE ${CMAKE_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/cellmirror)
