# Configures a copy of the project in WORK_DIR in which PIPELINE links LINK, and compares what CMake
# says with EXPECTED.
set(copy ${WORK_DIR}/source)
file(REMOVE_RECURSE ${WORK_DIR})
foreach(part CMakeLists.txt deploy idl pipelines schemas services)
  file(COPY ${SOURCE_DIR}/${part} DESTINATION ${copy})
endforeach()
file(APPEND ${copy}/pipelines/${PIPELINE}/CMakeLists.txt
  "target_link_libraries(spindrift_${PIPELINE} ${SCOPE} ${LINK})\n")

execute_process(
  COMMAND ${CMAKE_COMMAND} -G ${GENERATOR} -S ${copy} -B ${WORK_DIR}/build -D BUILD_TESTING=OFF
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
string(REGEX REPLACE "[ \n]+" " " output "${output}")
file(REMOVE_RECURSE ${WORK_DIR})

if(EXPECTED STREQUAL "accepted")
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "CMake refused ${PIPELINE} linking ${LINK}: ${output}")
  endif()
elseif(result EQUAL 0 OR NOT output MATCHES "The pipeline '${PIPELINE}' links ${LINK}\\.")
  message(FATAL_ERROR "CMake did not refuse ${PIPELINE} linking ${LINK}: ${output}")
endif()
