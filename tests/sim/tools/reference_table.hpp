/// @file
/// Reads a gzipped CSV of numbers of the reference vectors.
#pragma once

#include <zlib.h>

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

namespace leeway::test {

/// Rows without the header; empty when the file is absent.
inline std::vector<std::vector<double>> reference_table(const std::string& vector_and_file) {
  std::vector<std::vector<double>> rows;
  const std::string path = LEEWAY_SHARED_DIR "/reference/vectors/" + vector_and_file;
  gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) return rows;
  std::array<char, 1024> line{};
  gzgets(file, line.data(), static_cast<int>(line.size()));
  while (gzgets(file, line.data(), static_cast<int>(line.size())) != nullptr) {
    std::vector<double>& row = rows.emplace_back();
    char* at = line.data();
    do {
      row.push_back(std::strtod(at, &at));
    } while (*at++ == ',');
  }
  gzclose(file);
  return rows;
}

}  // namespace leeway::test
