// Tables of numbers in text files.
#pragma once

#include <string>
#include <vector>

namespace nullcone::postrender {

/// Rows of a CSV file: numbers separated by commas, semicolons or blanks, the same count in each; at least
/// two rows, the first column positive and increasing. Lines that are empty or begin with '#' are left out,
/// as is a first line of words. Throws InputError "file: line n: ..."; `pointer` names the entry of the look.
std::vector<std::vector<double>> read_table(const std::string& path, const std::string& pointer);

}  // namespace nullcone::postrender
