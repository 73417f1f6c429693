# Run at every build: writes OUTPUT only when the commit has changed, so that nothing else is rebuilt.
cmake_minimum_required(VERSION 3.25)
execute_process(
  COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(commit)
  set(VERSION "${VERSION}+${commit}")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT
"#include \"services/processor/version.h\"

namespace spindrift {

const char* const kSoftwareVersion = \"@VERSION@\";

}  // namespace spindrift
")
