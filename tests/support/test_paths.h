/// @file
/// Paths of test data and programs.

#pragma once

#include <filesystem>

namespace spindrift {

std::filesystem::path source_folder();
/// Returns tests/data.
std::filesystem::path test_data();
std::filesystem::path recorded_passes();
/// Returns the folder of the scenarios that are delivered with the project.
std::filesystem::path scenarios();
std::filesystem::path spindrift_program();
/// Returns the example subscriber (idl/examples).
std::filesystem::path example_program();
/// Returns the program of support/bus_foreign_writer.cpp.
std::filesystem::path foreign_writer_program();
/// Returns whether the program under test was built with a sanitizer.
bool is_sanitized();

}  // namespace spindrift
