#pragma once
/// What the commands of `fase bench` have in common: the CSV file, and the end of a measurement.
#include <string>
#include <vector>

#include "fase/core/result.hpp"

namespace fase::cli {

/// Refuses a CSV file that cannot be written, before anything is measured. An empty name means none.
Result<void> check_csv(const std::string& file);
/// Appends rows to a CSV file, with date, commit and machine in front of each. `columns` name the rest. Does nothing
/// for an empty name or no rows. Creates the folder.
Result<void> append_rows(const std::string& file, std::vector<std::string> columns,
                         std::vector<std::vector<std::string>> rows);
/// Prints the rows and returns the exit code: that of a signal, else whether all answers were right.
int print_rows(const std::string& text, bool all_right);

}  // namespace fase::cli
