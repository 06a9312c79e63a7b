# Manual pages and completions for bash. cmake/help.awk makes them from the output of --help, so each option is
# described in one place. They are left out if there is no awk, or if the programs are for another machine.
find_program(PTRIANGLE_AWK awk)
get_property(programs GLOBAL PROPERTY PTRIANGLE_EXECUTABLES)
if(NOT PTRIANGLE_AWK OR (CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR))
    message(STATUS "no manual pages: they are made by awk of what the programs print")
    return()
endif()

# The names under which the programs are installed.
set(names ${programs})
list(TRANSFORM names REPLACE "^(triangle|trianglecheck|meshplot)$" "${PTRIANGLE_PREFIX}\\1")
list(JOIN names " " all_names)
set(folder ${CMAKE_CURRENT_BINARY_DIR}/documents)
file(MAKE_DIRECTORY ${folder})

# ptriangle_document(<program> <name> man|bash <file>)
function(ptriangle_document program name form file)
    add_custom_command(OUTPUT ${file}
        COMMAND ${program} --help > ${file}.help
        COMMAND ${PTRIANGLE_AWK} -v form=${form} -v name=${name} -v version=${PROJECT_VERSION} -v "others=${all_names}"
                -f ${CMAKE_CURRENT_SOURCE_DIR}/cmake/help.awk ${file}.help > ${file}
        DEPENDS ${program} ${CMAKE_CURRENT_SOURCE_DIR}/cmake/help.awk VERBATIM)
    set_property(GLOBAL APPEND PROPERTY PTRIANGLE_DOCUMENTS ${file})
endfunction()

foreach(program name IN ZIP_LISTS programs names)
    ptriangle_document(${program} ${name} man ${folder}/${name}.1)
    ptriangle_document(${program} ${name} bash ${folder}/${name})
endforeach()
get_property(documents GLOBAL PROPERTY PTRIANGLE_DOCUMENTS)
add_custom_target(ptriangle_documents ALL DEPENDS ${documents})
