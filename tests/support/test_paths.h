/// @file
/// Where the tests find data and programs.

#pragma once

#include <filesystem>

namespace spindrift {

std::filesystem::path source_folder();
/// tests/data.
std::filesystem::path test_data();
/// The recorded passes of test_data().
std::filesystem::path recorded_passes();
/// The scenarios that the project delivers.
std::filesystem::path scenarios();
/// The program under test.
std::filesystem::path spindrift_program();
/// The example of a subscriber (idl/examples).
std::filesystem::path example_program();
/// A writer of telemetry in another process (support/bus_foreign_writer.cpp).
std::filesystem::path foreign_writer_program();
/// Whether a sanitizer is built into that program.
bool is_sanitized();

}  // namespace spindrift
