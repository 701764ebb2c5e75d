// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "prodomos/base/progress.hpp"

#include "io/decompressor.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace prodomos::io {

/// A file read from front to back through the compression that its first bytes show: gzip, bzip2 or none.
class InputFile {
 public:
  /// Throws base::FileError where the file is missing or cannot be read.
  explicit InputFile(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }

  /// Up to `size` bytes; fewer only at the end.
  std::size_t read(void* destination, std::size_t size);
  /// The bytes that read() gives next, at most kBufferSize of them; fewer than `size` only at the end.
  std::string_view peek(std::size_t size);
  /// The next line without its end; false at the end of the file.
  bool readLine(std::string& line);
  bool atEnd() { return peek(1).empty(); }

  /// Decompressed bytes read so far.
  std::uint64_t position() const { return position_; }
  /// Why the decompressed bytes end early: the compressed stream is cut or damaged. Empty where all is well.
  const std::string& damage() const { return damage_; }
  /// In bytes of the file as stored.
  base::Progress progress() const;

  static constexpr std::size_t kBufferSize = std::size_t{1} << 16;

 private:
  /// Bytes in a block of memory of which [begin, end) are not yet used.
  struct Buffer {
    std::vector<char> bytes = std::vector<char>(kBufferSize);
    std::size_t begin = 0;
    std::size_t end = 0;

    std::size_t size() const { return end - begin; }
    void makeRoom();
  };

  void fill();
  void loadStored();
  void use(std::size_t count);

  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t fileSize_ = 0;
  std::uint64_t loaded_ = 0;
  std::unique_ptr<Decompressor> decompressor_;
  Buffer stored_;
  Buffer plain_;
  std::uint64_t position_ = 0;
  std::string damage_;
};

}  // namespace prodomos::io
