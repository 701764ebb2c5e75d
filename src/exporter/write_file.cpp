// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/write_file.hpp"

#include "prodomos/base/error.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace prodomos::exporter {

void writeFile(const std::filesystem::path& path, std::string_view bytes) {
  const auto fail = [&path](const std::string& found) {
    throw base::FileError(base::expectedFound(path.string(), "a file that can be written", found));
  };
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) fail("a folder");

  std::filesystem::path unfinished = path;
  unfinished += ".part";
  errno = 0;
  std::ofstream out(unfinished, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "no room";
    std::filesystem::remove(unfinished, error);
    fail(reason);
  }
  std::filesystem::rename(unfinished, path, error);
  if (error) {
    const std::string reason = error.message();
    std::filesystem::remove(unfinished, error);
    fail(reason);
  }
}

}  // namespace prodomos::exporter
