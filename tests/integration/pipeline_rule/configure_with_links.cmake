# Configures a copy of the project in WORK_DIR in which pipelines link what they may and what they may not,
# one of each kind, and compares what CMake refuses with it.
set(copy ${WORK_DIR}/source)
file(REMOVE_RECURSE ${WORK_DIR})
foreach(part CMakeLists.txt deploy idl pipelines schemas services)
  file(COPY ${SOURCE_DIR}/${part} DESTINATION ${copy})
endforeach()

function(link_in_copy pipeline scope link)
  file(APPEND ${copy}/pipelines/${pipeline}/CMakeLists.txt
    "target_link_libraries(spindrift_${pipeline} ${scope} ${link})\n")
endfunction()

link_in_copy(time PRIVATE PkgConfig::SQLITE3)
link_in_copy(geomagnetism PRIVATE spindrift::base)
link_in_copy(statistics PUBLIC Threads::Threads)
link_in_copy(core INTERFACE Threads::Threads)
link_in_copy(three_axis PRIVATE Eigen3::Eigen)
link_in_copy(frames PRIVATE spindrift::time)
set(expected "core Threads::Threads" "geomagnetism spindrift::base" "statistics Threads::Threads" "time PkgConfig::SQLITE3")

execute_process(
  COMMAND ${CMAKE_COMMAND} -G ${GENERATOR} -S ${copy} -B ${WORK_DIR}/build -D BUILD_TESTING=OFF
    -D CMAKE_C_COMPILER=${C_COMPILER} -D CMAKE_CXX_COMPILER=${CXX_COMPILER}
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
file(REMOVE_RECURSE ${WORK_DIR})

string(REGEX REPLACE "[ \n]+" " " output "${output}")
string(REGEX MATCHALL "The pipeline '[a-z_]+' links [A-Za-z0-9_:]+\\." refused "${output}")
list(TRANSFORM refused REPLACE "The pipeline '([a-z_]+)' links (.*)\\.$" "\\1 \\2")
list(SORT refused)
if(result EQUAL 0 OR NOT refused STREQUAL expected)
  message(FATAL_ERROR "CMake must refuse these links: ${expected}; it refused: ${refused}; it said: ${output}")
endif()
