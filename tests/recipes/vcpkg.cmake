# Stub for vcpkg: runs a portfile. The functions do the same as vcpkg's, for one Release build.
# Usage: cmake -DARCHIVE=... -DWORK=... -DVERSION=... -DPORT=FOLDER -P vcpkg.cmake
cmake_minimum_required(VERSION 3.22)
set(folder ${PORT})
set(PORT ptriangle)
set(CURRENT_PACKAGES_DIR ${WORK}/packages)

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(vcpkg_download_distfile out)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "URLS;FILENAME;SHA512" "")
    if(NOT (arg_URLS AND arg_FILENAME AND DEFINED arg_SHA512))
        message(FATAL_ERROR "vcpkg_download_distfile: URLS, FILENAME, SHA512")
    endif()
    set(${out} ${ARCHIVE} PARENT_SCOPE)
endfunction()

function(vcpkg_extract_source_archive out)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "ARCHIVE" "")
    file(ARCHIVE_EXTRACT INPUT ${arg_ARCHIVE} DESTINATION ${WORK}/source)
    file(GLOB tree ${WORK}/source/*)
    set(${out} ${tree} PARENT_SCOPE)
endfunction()

function(vcpkg_cmake_configure)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "SOURCE_PATH" "OPTIONS")
    run(${CMAKE_COMMAND} -S ${arg_SOURCE_PATH} -B ${WORK}/build -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=OFF
        -DCMAKE_INSTALL_PREFIX=${CURRENT_PACKAGES_DIR} -DCMAKE_INSTALL_LIBDIR:STRING=lib ${arg_OPTIONS})
endfunction()

function(vcpkg_cmake_install)
    run(${CMAKE_COMMAND} --build ${WORK}/build --target install --parallel 2)
endfunction()

function(vcpkg_cmake_config_fixup)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "CONFIG_PATH" "")
    file(MAKE_DIRECTORY ${CURRENT_PACKAGES_DIR}/share)
    file(RENAME ${CURRENT_PACKAGES_DIR}/${arg_CONFIG_PATH} ${CURRENT_PACKAGES_DIR}/share/${PORT})
endfunction()

function(vcpkg_fixup_pkgconfig)
endfunction()

function(vcpkg_install_copyright)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "FILE_LIST")
    file(COPY_FILE ${arg_FILE_LIST} ${CURRENT_PACKAGES_DIR}/share/${PORT}/copyright)
endfunction()

file(READ ${folder}/vcpkg.json manifest)
string(JSON stated GET "${manifest}" version)
if(NOT stated STREQUAL VERSION)
    message(FATAL_ERROR "vcpkg.json has version ${stated}")
endif()
file(COPY ${folder}/portfile.cmake DESTINATION ${WORK}/port)
file(COPY ${folder}/usage DESTINATION ${WORK}/port)
include(${WORK}/port/portfile.cmake)
foreach(file IN ITEMS share/ptriangle/ptriangleConfig.cmake share/ptriangle/usage share/ptriangle/copyright
                      lib/libptriangle.a include/ptriangle/tri.h)
    if(NOT EXISTS ${CURRENT_PACKAGES_DIR}/${file})
        message(FATAL_ERROR "no ${file}")
    endif()
endforeach()
file(GLOB_RECURSE misplaced ${CURRENT_PACKAGES_DIR}/lib/cmake/* ${CURRENT_PACKAGES_DIR}/bin/*)
if(misplaced)
    message(FATAL_ERROR "files at places that vcpkg does not allow")
endif()
