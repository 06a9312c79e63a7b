vcpkg_download_distfile(ARCHIVE
    URLS "https://ptriangle.invalid/releases/ptriangle-${VERSION}.tar.gz"
    FILENAME "ptriangle-${VERSION}.tar.gz"
    SHA512 0 # of the release archive: none exists yet
)
vcpkg_extract_source_archive(SOURCE_PATH ARCHIVE "${ARCHIVE}")

vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS
        -DPTRIANGLE_MPI=OFF
        -DPTRIANGLE_OPENMP=OFF
        -DPTRIANGLE_PROGRAMS=OFF
)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/ptriangle)
vcpkg_fixup_pkgconfig()

file(REMOVE_RECURSE
    "${CURRENT_PACKAGES_DIR}/debug/include"
    "${CURRENT_PACKAGES_DIR}/debug/share"
    "${CURRENT_PACKAGES_DIR}/share/doc"
)
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
