# Shared libraries for clients. Each has its own objects and exports only the functions in cmake/exports.map. So
# libptriangle contains libtriangle, whose internal functions it uses, and libptriangle-files contains the parts that it
# needs. A client links libtriangle or libptriangle, and libptriangle-files if it reads or writes files.

# On Windows there is one DLL with all functions, its import library, and the list of its functions for other linkers.
if(WIN32)
    set(sources ${PTRIANGLE_MESHER_SOURCES} ${PTRIANGLE_CHECK_SOURCES} ${PTRIANGLE_TEXT_SOURCES})
    if(TARGET libptriangle)
        list(REMOVE_ITEM sources triangle/dropin/triangulate.c) # the other triangulate() is that of sched/
        list(APPEND sources ${PTRIANGLE_SCHED_SOURCES})
    endif()
    list(REMOVE_DUPLICATES sources)
    add_library(libptriangle_shared SHARED ${sources} ${CMAKE_CURRENT_BINARY_DIR}/ptriangle.def)
    add_library(ptriangle::ptriangle ALIAS libptriangle_shared)
    ptriangle_library_settings(libptriangle_shared ptriangle)
    ptriangle_dropin(libptriangle_shared)
    ptriangle_static_runtime(libptriangle_shared)
    ptriangle_write_exports(${CMAKE_CURRENT_BINARY_DIR}/ptriangle.def "EXPORTS\n" "    ")
    set_target_properties(libptriangle_shared PROPERTIES PREFIX "")
    target_compile_options(libptriangle_shared PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions -fno-rtti>)
    if(TARGET libptriangle)
        target_link_libraries(libptriangle_shared PRIVATE $<BUILD_INTERFACE:ptriangle_threads>)
    endif()
    set_property(GLOBAL APPEND PROPERTY PTRIANGLE_LIBRARIES libptriangle_shared)
    return()
endif()

# Before 1.0 every minor version may change the interface.
function(ptriangle_shared name)
    set(target lib${name}_shared)
    add_library(${target} SHARED ${ARGN})
    add_library(ptriangle::${name} ALIAS ${target})
    ptriangle_library_settings(${target} ${name})
    set_target_properties(${target} PROPERTIES
        VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
        INSTALL_RPATH $<IF:$<BOOL:${APPLE}>,@loader_path,$ORIGIN>)
    target_compile_options(${target} PRIVATE -fno-semantic-interposition)
    ptriangle_exports(${target})
    set_target_properties(lib${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    set_property(GLOBAL APPEND PROPERTY PTRIANGLE_LIBRARIES ${target})
endfunction()

ptriangle_shared(triangle ${PTRIANGLE_MESHER_SOURCES})
set_target_properties(libtriangle_shared PROPERTIES OUTPUT_NAME ${PTRIANGLE_PREFIX}triangle)
ptriangle_dropin(libtriangle_shared)
target_link_libraries(libtriangle_shared PRIVATE m)

ptriangle_shared(ptriangle-check ${PTRIANGLE_CHECK_SOURCES} ${PTRIANGLE_CHECK_NEEDS})
target_link_libraries(libptriangle-check_shared PRIVATE m)

ptriangle_shared(ptriangle-files ${PTRIANGLE_TEXT_SOURCES} ${PTRIANGLE_TEXT_NEEDS})
target_compile_options(libptriangle-files_shared PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions -fno-rtti>)
ptriangle_static_runtime(libptriangle-files_shared)

set(mesher ${PTRIANGLE_MESHER_SOURCES})
list(REMOVE_ITEM mesher triangle/dropin/triangulate.c) # its triangulate() is the other one
ptriangle_shared(ptriangle ${mesher} ${PTRIANGLE_SCHED_SOURCES})
ptriangle_dropin(libptriangle_shared)
target_link_libraries(libptriangle_shared PRIVATE m $<BUILD_INTERFACE:ptriangle_threads>)
if(OpenMP_C_FOUND AND NOT APPLE) # whose runtime has threads that live on for a while: it must not be unloaded
    target_link_options(libptriangle_shared PRIVATE LINKER:-z,nodelete)
endif()
if(TARGET libptriangle-mpi)
    ptriangle_shared(ptriangle-mpi ${PTRIANGLE_MPI_SOURCES})
    target_link_libraries(libptriangle-mpi_shared PUBLIC libptriangle_shared MPI::MPI_C)
endif()
