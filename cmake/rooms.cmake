# A room is one folder of the house and one static library. Its headers are reached as "room/header.h", and only by
# targets that link it: every room has an include root of its own that holds nothing but a link to its folder, so an
# include that points the other way does not compile.

set(PROBEWARP_WARNINGS -Wall -Wextra -Wshadow -Wconversion -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    list(APPEND PROBEWARP_WARNINGS -Wno-restrict)  # GCC 12 sees overlaps in std::string's operator+ (bug 105651)
endif()

function(probewarp_own_code target)
    target_compile_options(${target} PRIVATE ${PROBEWARP_WARNINGS})
endfunction()

# probewarp_room(NAME [SOURCES ...] [USES other rooms ...] [LIBRARIES ...])
function(probewarp_room name)
    cmake_parse_arguments(ROOM "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
    set(root ${CMAKE_BINARY_DIR}/rooms/${name})
    file(MAKE_DIRECTORY ${root})
    file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${name} ${root}/${name} SYMBOLIC)
    list(TRANSFORM ROOM_SOURCES PREPEND ${name}/)
    if(ROOM_SOURCES)
        add_library(${name} STATIC ${ROOM_SOURCES})
        target_include_directories(${name} PUBLIC ${root})
        target_link_libraries(${name} PUBLIC ${ROOM_USES} PRIVATE ${ROOM_LIBRARIES})
        probewarp_own_code(${name})
    else()
        add_library(${name} INTERFACE)
        target_include_directories(${name} INTERFACE ${root})
        target_link_libraries(${name} INTERFACE ${ROOM_USES} ${ROOM_LIBRARIES})
    endif()
endfunction()
