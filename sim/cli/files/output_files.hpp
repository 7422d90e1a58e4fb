/// @file
/// The files that a command writes: claimed before it runs, so that none replaces what it should
/// not, and no work is lost for want of a place to write it to.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>

namespace leeway::cli {

/// An option that takes the name of a file to write.
CLI::Option* add_output_file(CLI::App& app, const std::string& name, std::filesystem::path& file,
                             const std::string& meaning, const char* type = "FILE");

/// Claims the files that the options of a command name. A signal that ends the program removes what
/// has been written of them.
/// @throws Error when one is no regular file, or what another option names; WriteFailure when it
/// cannot be created
void claim_output_files(const CLI::App& app);

/// Claims further files of a command, such as those in a folder.
void claim_output_file(const std::filesystem::path& file);

}  // namespace leeway::cli
