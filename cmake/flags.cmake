# Compiler options. ptriangle_flags(<target> [STRICT]) is called for each target. Only the sanitizers are set globally,
# because every object and every link needs them. STRICT adds warnings for our own code; tests leave it out because of
# cmocka's macros.

option(PTRIANGLE_STATIC_RUNTIME "The programs carry the C++ runtime inside" ON)
option(PTRIANGLE_WERROR "Treat warnings as errors" OFF)
option(PTRIANGLE_NATIVE "Compile for the processor of this machine (-march=native); results stay the same" OFF)
set(PTRIANGLE_SANITIZE "" CACHE STRING "Sanitizers for the whole build, such as address,undefined or thread")

# Debug keeps the asserts, and enough optimisation for fast tests.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug, RelWithDebInfo, MinSizeRel" FORCE)
endif()
set(PTRIANGLE_DEBUG_FLAGS $<$<CONFIG:Debug>:-O1>)

if(PTRIANGLE_SANITIZE)
    add_compile_options(-fsanitize=${PTRIANGLE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    add_link_options(-fsanitize=${PTRIANGLE_SANITIZE})
endif()

# All objects have coverage for libFuzzer. Only the fuzz targets link its main().
if(PTRIANGLE_FUZZ)
    add_compile_options(-fsanitize=fuzzer-no-link)
    add_link_options(-fsanitize=fuzzer-no-link)
endif()

# Left out: -Wsign-conversion, which would require a cast for each 32-bit id that is an index, and -Wdouble-promotion,
# which warns of INFINITY.
set(PTRIANGLE_WARNINGS -Wall -Wextra -Wshadow)
set(PTRIANGLE_STRICT_WARNINGS
    -Wpedantic -Wconversion -Wno-sign-conversion -Wvla -Wundef -Wwrite-strings
    $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes>
    $<$<COMPILE_LANGUAGE:C>:-Wmissing-prototypes>
    $<$<COMPILE_LANGUAGE:C>:-Wold-style-definition>
    -Wno-unknown-pragmas) # OpenMP's, where it is left out
if(MINGW) # printf() is that of C here, which the compiler does not know, and isfinite() a macro that looks at a float
    add_compile_definitions(__USE_MINGW_ANSI_STDIO=1)
    list(APPEND PTRIANGLE_WARNINGS -Wno-format -Wno-format-extra-args -Wno-float-conversion)
endif()

# Each operation on doubles must be rounded to a double as written. Otherwise the exact predicates fail, and meshes
# differ between compilers (triangle/base/arithmetic.h). So there is no fused multiply-add, no -ffast-math and no x87.
# These options follow CFLAGS and CMAKE_C_FLAGS, so they override them; only -Ofast cannot be overridden. Linking needs
# the options too, because compilers may add code there that disables subnormals for the whole process. The options are
# private and do not apply to the code of clients.
include(CheckCSourceCompiles)
set(PTRIANGLE_ARITHMETIC -fno-fast-math -fno-unsafe-math-optimizations -ffp-contract=off)
check_c_source_compiles("#ifndef __i386__\n#error other\n#endif\nint main(void) { return 0; }" PTRIANGLE_I386)
if(PTRIANGLE_I386)
    list(APPEND PTRIANGLE_ARITHMETIC -msse2 -mfpmath=sse)
endif()
foreach(flags CMAKE_C_FLAGS CMAKE_CXX_FLAGS)
    string(REPLACE "-Ofast" "-O3" ${flags} "${${flags}}")
endforeach()

# Compilers pack the two coordinates of a point into one register. Most operations on points are cross products, which
# need them unpacked again. Without this packing refinement is up to a tenth faster.
set(PTRIANGLE_SPEED -fno-tree-slp-vectorize)

# Hidden symbols let the compiler inline position-independent code. They also prevent shared libraries of clients from
# exporting our symbols.
function(ptriangle_flags target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "STRICT" "" "")
    set_target_properties(${target} PROPERTIES
        C_STANDARD 11 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF
        CXX_STANDARD 17 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
        C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
    target_compile_options(${target} PRIVATE ${PTRIANGLE_DEBUG_FLAGS} ${PTRIANGLE_SPEED} ${PTRIANGLE_WARNINGS})
    if(arg_STRICT) # C11's library alone: the system is behind triangle/base/system.h
        target_compile_options(${target} PRIVATE ${PTRIANGLE_STRICT_WARNINGS})
    else()
        target_compile_definitions(${target} PRIVATE $<$<COMPILE_LANGUAGE:C>:_POSIX_C_SOURCE=200809L>)
    endif()
    if(PTRIANGLE_WERROR)
        target_compile_options(${target} PRIVATE -Werror)
    endif()
    if(PTRIANGLE_NATIVE)
        target_compile_options(${target} PRIVATE -march=native)
    endif()
    target_compile_options(${target} PRIVATE ${PTRIANGLE_ARITHMETIC})
    target_link_options(${target} PRIVATE -fno-fast-math -fno-unsafe-math-optimizations)
endfunction()

# The executables contain the C++ runtime, so that they run without an installed libstdc++. Builds with sanitizers are
# the exception, because their runtime needs the shared libstdc++.
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_LINK_OPTIONS -static-libstdc++ -static-libgcc)
check_cxx_source_compiles("#include <string>\nint main(int n, char **) { return std::string(n, 'x').size() == 0; }"
                          PTRIANGLE_HAVE_STATIC_RUNTIME)
unset(CMAKE_REQUIRED_LINK_OPTIONS)

# Name of the C++ runtime for C clients.
set(PTRIANGLE_CXX_RUNTIME stdc++)
if("c++" IN_LIST CMAKE_CXX_IMPLICIT_LINK_LIBRARIES)
    set(PTRIANGLE_CXX_RUNTIME c++)
endif()

function(ptriangle_static_runtime target)
    if(PTRIANGLE_STATIC_RUNTIME AND PTRIANGLE_HAVE_STATIC_RUNTIME AND NOT PTRIANGLE_SANITIZE)
        target_link_options(${target} PRIVATE -static-libstdc++ -static-libgcc)
    endif()
endfunction()

# Functions that cmake/exports.map lists, except those for MPI, for linkers that cannot read such a map: the text
# `before`, then one line per name.
function(ptriangle_write_exports file before prefix)
    file(STRINGS ${PROJECT_SOURCE_DIR}/cmake/exports.map names REGEX "^    [a-z_]+;$")
    list(TRANSFORM names REPLACE " *([a-z_]+);" "${prefix}\\1")
    list(FILTER names EXCLUDE REGEX "par_stream_on$")
    list(JOIN names "\n" names)
    file(WRITE ${file} "${before}${names}\n")
endfunction()

# ptriangle_exports(<target>): the shared library exports nothing else. Not for DLLs.
include(CheckLinkerFlag)
function(ptriangle_exports target)
    if(APPLE)
        set(list ${CMAKE_CURRENT_BINARY_DIR}/exports.txt)
        ptriangle_write_exports(${list} "" _)
        check_linker_flag(C "SHELL:-Xlinker -exported_symbols_list -Xlinker \"${list}\"" PTRIANGLE_HAVE_EXPORT_LIST)
        if(PTRIANGLE_HAVE_EXPORT_LIST) # zig ignores it
            target_link_options(${target} PRIVATE "SHELL:-Xlinker -exported_symbols_list -Xlinker \"${list}\"")
        endif()
    else()
        check_linker_flag(C LINKER:-Bsymbolic-functions PTRIANGLE_HAVE_BSYMBOLIC) # zig has none
        check_linker_flag(C LINKER:--undefined-version PTRIANGLE_HAVE_UNDEFINED_VERSION) # lld: the map names MPI's, too
        target_link_options(${target} PRIVATE
            # the path as a word of its own: in LINKER: a comma would end it
            "SHELL:-Xlinker \"--version-script=${PROJECT_SOURCE_DIR}/cmake/exports.map\""
            $<$<BOOL:${PTRIANGLE_HAVE_BSYMBOLIC}>:LINKER:-Bsymbolic-functions>
            $<$<BOOL:${PTRIANGLE_HAVE_UNDEFINED_VERSION}>:LINKER:--undefined-version> LINKER:-z,defs)
    endif()
    set_target_properties(${target} PROPERTIES
        C_VISIBILITY_PRESET default LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/exports.map)
endfunction()

# <charconv> reads and writes numbers. It supports floating point since libstdc++ 11.
set(CMAKE_REQUIRED_FLAGS -std=c++17)
check_cxx_source_compiles("
    #include <charconv>
    int main()
    {
        char text[32] = \"1.5\";
        double x = 0;
    #ifndef _LIBCPP_VERSION // of which triangle/text/decimal.cpp needs neither
        std::from_chars(text, text + 3, x);
        std::to_chars(text, text + 32, x);
    #else
        x = 1.5;
    #endif
        return x != 1.5;
    }" PTRIANGLE_HAVE_CHARCONV)
unset(CMAKE_REQUIRED_FLAGS)
if(NOT PTRIANGLE_HAVE_CHARCONV)
    message(FATAL_ERROR "The C++ compiler has no std::from_chars and std::to_chars for double: use GCC 11 or newer, or "
                        "clang with libc++ or with the libstdc++ of GCC 11 or newer (Debian 12, Ubuntu 22.04).")
endif()
