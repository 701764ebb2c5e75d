// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>
#include <zlib.h>

#include <filesystem>

namespace prodomos::io {

/// Serialised MRPT objects one after the other, gzip'd. Throws base::FileError as soon as a write fails.
class ObjectFile {
 public:
  explicit ObjectFile(const std::filesystem::path& path);
  ObjectFile(const ObjectFile&) = delete;
  ObjectFile& operator=(const ObjectFile&) = delete;
  ~ObjectFile();

  void write(const mrpt::serialization::CSerializable& object);
  void close();

 private:
  struct Archive final : mrpt::serialization::CArchive {
    std::size_t read(void* destination, std::size_t size) override;
    std::size_t write(const void* source, std::size_t size) override;

    gzFile file = nullptr;
    bool hasFailed = false;  ///< not told to MRPT, which would write of it to std::cerr before it throws
  };

  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  Archive archive_;
};

}  // namespace prodomos::io
