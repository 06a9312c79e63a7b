# cmake --install: executables, libraries, public headers, CMake package, pkg-config files. Installed files contain no
# paths of the build machine, so the tree may be moved. Components: programs, runtime (shared libraries)
# and development.

include(CMakePackageConfigHelpers)
set(PTRIANGLE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/ptriangle)

get_property(libraries GLOBAL PROPERTY PTRIANGLE_LIBRARIES)
set(mpi_library ${libraries})
list(FILTER mpi_library INCLUDE REGEX "^libptriangle-mpi")
list(FILTER libraries EXCLUDE REGEX "^libptriangle-mpi")
get_property(executables GLOBAL PROPERTY PTRIANGLE_EXECUTABLES)
install(TARGETS ${libraries} EXPORT ptriangleTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development)
if(TARGET libptriangle-mpi) # may be installed apart from the others
    install(TARGETS ${mpi_library} EXPORT ptriangleMpiTargets
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development)
    install(EXPORT ptriangleMpiTargets NAMESPACE ptriangle:: DESTINATION ${PTRIANGLE_PACKAGE_DIR}
            COMPONENT development)
endif()
if(executables)
    install(TARGETS ${executables} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
endif()
get_property(modules GLOBAL PROPERTY PTRIANGLE_MODULE_TARGETS)
if(modules) # at their place seen from the executables
    install(TARGETS ${modules} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/ptriangle COMPONENT programs)
endif()
get_property(documents GLOBAL PROPERTY PTRIANGLE_DOCUMENTS)
foreach(document IN LISTS documents)
    if(document MATCHES "\\.1$")
        install(FILES ${document} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT programs)
    else()
        install(FILES ${document} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT programs)
    endif()
endforeach()
install(FILES ${PTRIANGLE_PUBLIC_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ptriangle COMPONENT development)
if(TARGET libptriangle-mpi)
    install(FILES ${PTRIANGLE_MPI_HEADER} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ptriangle COMPONENT development)
endif()
install(FILES triangle/dropin/triangle.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} # where Triangle's clients look for it
        RENAME ${PTRIANGLE_PREFIX}triangle.h COMPONENT development)

install(EXPORT ptriangleTargets NAMESPACE ptriangle:: DESTINATION ${PTRIANGLE_PACKAGE_DIR}
        COMPONENT development)
configure_package_config_file(cmake/ptriangleConfig.cmake.in ptriangleConfig.cmake
                              INSTALL_DESTINATION ${PTRIANGLE_PACKAGE_DIR})
write_basic_package_version_file(ptriangleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ptriangleConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/ptriangleConfigVersion.cmake
        DESTINATION ${PTRIANGLE_PACKAGE_DIR} COMPONENT development)

# pkg-config: the way from the .pc file up to the prefix depends on the library folder (lib, lib64, lib/x86_64-...).
file(RELATIVE_PATH PTRIANGLE_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" PTRIANGLE_PC_PREFIX ${PTRIANGLE_PC_PREFIX})
set(PTRIANGLE_PC_SINGLE "")
if(PTRIANGLE_SINGLE)
    set(PTRIANGLE_PC_SINGLE " -DSINGLE")
endif()
# A shared library lists its own dependencies. For a static one the linker of the client needs the list. It is public if
# there are only static libraries; otherwise pkg-config --static prints it, for static libraries installed beside.
set(PTRIANGLE_PC_LIBRARY ${PTRIANGLE_PREFIX}triangle)
set(PTRIANGLE_PC_NEEDS -lm)
set(PTRIANGLE_PC_PARALLEL "-lptriangle -lptriangle-check -lptriangle-files")
list(TRANSFORM PTRIANGLE_THREADS_RUNTIME REPLACE "^([^/].*)" "-l\\1" OUTPUT_VARIABLE runtime)
list(JOIN runtime " " runtime)
set(PTRIANGLE_PC_PARALLEL_NEEDS "-l${PTRIANGLE_PC_LIBRARY} ${runtime} -l${PTRIANGLE_CXX_RUNTIME} -lm")
if(BUILD_SHARED_LIBS)
    string(PREPEND PTRIANGLE_PC_NEEDS "\nLibs.private: ")
    string(PREPEND PTRIANGLE_PC_PARALLEL_NEEDS "\nLibs.private: ")
endif()
configure_file(cmake/triangle.pc.in ${PTRIANGLE_PREFIX}triangle.pc @ONLY)
configure_file(cmake/ptriangle.pc.in ptriangle.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${PTRIANGLE_PREFIX}triangle.pc ${CMAKE_CURRENT_BINARY_DIR}/ptriangle.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# The C compiler wrapper of the MPI adds the libraries that it needs.
if(TARGET libptriangle-mpi)
    configure_file(cmake/ptriangle-mpi.pc.in ptriangle-mpi.pc @ONLY)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ptriangle-mpi.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
            COMPONENT development)
endif()

install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)
