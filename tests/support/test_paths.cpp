#include "tests/support/test_paths.h"

namespace spindrift {

std::filesystem::path source_folder() { return SPINDRIFT_SOURCE_FOLDER; }

std::filesystem::path test_data() { return source_folder() / "tests" / "data"; }

std::filesystem::path recorded_passes() { return test_data() / "spin"; }

std::filesystem::path scenarios() { return source_folder() / "deploy" / "scenarios"; }

std::filesystem::path spindrift_program() { return SPINDRIFT_PROGRAM; }

std::filesystem::path example_program() { return SPINDRIFT_EXAMPLE; }
std::filesystem::path foreign_writer_program() { return SPINDRIFT_BUS_FOREIGN_WRITER; }

bool is_sanitized() { return SPINDRIFT_SANITIZED != 0; }

}  // namespace spindrift
