# The binaries of the Python package (python/): one shared library with all functions, and the programs. All contain the
# C++ runtime, so a wheel needs neither a compiler nor system packages, except that meshplot needs libcairo. The target
# python_package builds everything.
set(sources ${PTRIANGLE_MESHER_SOURCES} ${PTRIANGLE_CHECK_SOURCES} ${PTRIANGLE_TEXT_SOURCES})
list(REMOVE_ITEM sources triangle/dropin/triangulate.c) # the other triangulate() is that of sched/
list(APPEND sources ${PTRIANGLE_SCHED_SOURCES})
add_library(libptriangle_python SHARED ${sources})
ptriangle_library_settings(libptriangle_python ptriangle_python)
ptriangle_dropin(libptriangle_python)
ptriangle_static_runtime(libptriangle_python)
target_compile_options(libptriangle_python PRIVATE
    -fno-semantic-interposition $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions> $<$<COMPILE_LANGUAGE:CXX>:-fno-rtti>)
if(WIN32)
    ptriangle_write_exports(${CMAKE_CURRENT_BINARY_DIR}/python.def "EXPORTS\n" "    ")
    target_sources(libptriangle_python PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/python.def)
    set_target_properties(libptriangle_python PROPERTIES PREFIX lib)
else()
    set_target_properties(libptriangle_python PROPERTIES INSTALL_RPATH $ORIGIN BUILD_WITH_INSTALL_RPATH OFF
        INSTALL_NAME_DIR @rpath BUILD_WITH_INSTALL_NAME_DIR ON) # on macOS, no folder of this machine
    ptriangle_exports(libptriangle_python)
endif()
target_link_libraries(libptriangle_python PRIVATE m ptriangle_threads)
install(TARGETS libptriangle_python
        LIBRARY DESTINATION ptriangle COMPONENT python EXCLUDE_FROM_ALL
        RUNTIME DESTINATION ptriangle COMPONENT python EXCLUDE_FROM_ALL)

add_custom_target(python_package DEPENDS libptriangle_python)
foreach(program IN ITEMS ptriangle trianglecheck meshplot)
    if(TARGET ${program})
        add_dependencies(python_package ${program})
        install(TARGETS ${program} RUNTIME DESTINATION ptriangle/programs COMPONENT python EXCLUDE_FROM_ALL)
    endif()
endforeach()
