// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/input_file.hpp"

#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>

#include <cstdint>
#include <optional>
#include <string>

namespace prodomos::io {

/// The class name with which a serialised MRPT object begins, without namespaces; nothing where the bytes are no
/// object.
std::optional<std::string> objectClass(std::string_view bytes);

/// Serialised MRPT objects one after the other. MRPT's own reading takes a file that ends within an object for one that
/// ends after the object before; this one tells them apart, and says where.
class ObjectStream {
 public:
  explicit ObjectStream(InputFile file) : archive_(std::move(file)) {}

  /// The next object; null at the end, whatever its cause, and for an empty object (see `atEnd`).
  mrpt::serialization::CSerializable::Ptr next();
  bool atEnd() const { return atEnd_; }
  /// At the end: the line that tells where and why the file ends before its time; empty where it ends as it should.
  const std::string& fault() const { return fault_; }

  /// Names the last object, counted from 0: "log.rawlog: object 17".
  std::string place() const;
  base::Progress progress() const { return archive_.file.progress(); }

 private:
  struct Archive final : mrpt::serialization::CArchive {
    explicit Archive(InputFile inputFile) : file(std::move(inputFile)) {}
    std::size_t read(void* destination, std::size_t size) override;
    std::size_t write(const void* source, std::size_t size) override;

    InputFile file;
  };

  void endWith(const std::string& expected, const std::string& found);

  Archive archive_;
  std::uint64_t count_ = 0;
  std::uint64_t begin_ = 0;  ///< of the last object, in decompressed bytes
  bool atEnd_ = false;
  std::string fault_;
};

}  // namespace prodomos::io
