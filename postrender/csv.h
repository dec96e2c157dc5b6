// Tables of numbers in text files.
#pragma once

#include <string>
#include <vector>

namespace nullcone::postrender {

/// What the columns of a table are.
struct TableKind {
  std::string first = "a wavelength in nm", others = "its values";
  bool zero = false;   ///< the first column may begin at 0
  double most = 1e20;  ///< the others lie between 0 and this
};

/// Rows of a CSV file: numbers separated by commas, semicolons or blanks, the same count in each; 2 to 65536
/// rows, the first column positive and increasing. What follows a '#' is left out, as are empty lines and
/// a first line of names. Throws InputError "file: line n: ..."; `pointer` names the entry of the look.
std::vector<std::vector<double>> read_table(const std::string& path, const std::string& pointer,
                                            const TableKind& kind = {});

}  // namespace nullcone::postrender
