# cmake --install: executables, static libraries, public headers, CMake package, pkg-config files. Nothing installed
# names a folder of the machine that built it: the tree may be moved.

include(CMakePackageConfigHelpers)
set(PTRIANGLE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/ptriangle)

get_property(libraries GLOBAL PROPERTY PTRIANGLE_LIBRARIES)
get_property(executables GLOBAL PROPERTY PTRIANGLE_EXECUTABLES)
install(TARGETS ${libraries} EXPORT ptriangleTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS ${executables} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(header IN LISTS PTRIANGLE_PUBLIC_HEADERS)
    get_filename_component(room ${header} DIRECTORY)
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ptriangle/${room})
endforeach()
install(FILES triangle/triangle.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}) # where Triangle's clients look for it

install(EXPORT ptriangleTargets NAMESPACE ptriangle:: DESTINATION ${PTRIANGLE_PACKAGE_DIR})
configure_package_config_file(cmake/ptriangleConfig.cmake.in ptriangleConfig.cmake
                              INSTALL_DESTINATION ${PTRIANGLE_PACKAGE_DIR})
write_basic_package_version_file(ptriangleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ptriangleConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/ptriangleConfigVersion.cmake
        DESTINATION ${PTRIANGLE_PACKAGE_DIR})

# pkg-config: the way from the .pc file up to the prefix depends on the library folder (lib, lib64, lib/x86_64-...).
file(RELATIVE_PATH PTRIANGLE_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" PTRIANGLE_PC_PREFIX ${PTRIANGLE_PC_PREFIX})
set(PTRIANGLE_PC_SINGLE "")
if(PTRIANGLE_SINGLE)
    set(PTRIANGLE_PC_SINGLE " -DSINGLE")
endif()
set(PTRIANGLE_PC_SCHED "")
if(TARGET libptriangle)
    set(PTRIANGLE_PC_SCHED "-lptriangle ${OpenMP_C_FLAGS} ")
endif()
foreach(name triangle ptriangle)
    configure_file(cmake/${name}.pc.in ${name}.pc @ONLY)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()

install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
