// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/exporter/exporter.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace prodomos::test {

/// Gone with everything in it when the test ends.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "prodomos-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string readFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

/// Every file that the format writes, by name.
inline std::map<std::string, std::string> writeAll(std::string_view format, const map::MapView& view) {
  const TemporaryFolder folder;
  const auto* const exporter = exporter::findExporter(format);
  exporter->write(view, folder.path() / ("map" + std::string(exporter->extension)));
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (entry.is_regular_file()) {
      files[entry.path().lexically_relative(folder.path()).string()] = readFile(entry.path());
    }
  }
  return files;
}

/// The one file that the format writes.
inline std::string write(std::string_view format, const map::MapView& view) {
  const auto files = writeAll(format, view);
  EXPECT_EQ(files.size(), 1U) << format;
  return files.empty() ? "" : files.begin()->second;
}

/// What the program prints on its standard output, and whether it ended well; the text is in `argument`'s file.
struct Ran {
  bool well = false;
  std::string output;
};
inline Ran runPython(const std::string& script, const std::string& input) {
  const TemporaryFolder folder;
  const auto in = folder.path() / "input";
  const auto code = folder.path() / "script.py";
  const auto out = folder.path() / "output";
  std::ofstream(in, std::ios::binary) << input;
  std::ofstream(code) << script;
  const std::string command = "/usr/bin/python3 " + code.string() + " " + in.string() + " > " + out.string() + " 2>&1";
  const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe,cert-env33-c)
  return {status == 0, readFile(out)};
}

}  // namespace prodomos::test
