// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/object_stream.hpp"

#include "prodomos/base/error.hpp"

#include "io/mrpt_values.hpp"

#include <mrpt/rtti/CObject.h>

#include <algorithm>
#include <cctype>
#include <new>
#include <stdexcept>

namespace prodomos::io {

namespace {

/// As it stands in the stream, namespaces and all.
std::optional<std::string> storedClass(std::string_view bytes) {
  if (bytes.empty()) return std::nullopt;
  // A length of seven bits; the eighth is set, or else (before MRPT 0.5.5) three zero bytes follow.
  constexpr unsigned char kNewFormat = 0x80;
  constexpr std::size_t kLongestName = 120;
  const auto head = static_cast<unsigned char>(bytes.front());
  const std::size_t length = head & ~kNewFormat & 0xffU;
  const std::size_t begin = (head & kNewFormat) != 0 ? 1 : 4;
  if (length == 0 || length > kLongestName || bytes.size() < begin + length) return std::nullopt;
  if (begin == 4 && bytes.substr(1, 3) != std::string_view("\0\0\0", 3)) return std::nullopt;
  const auto name = bytes.substr(begin, length);
  const auto isNameCharacter = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == ':'; };
  if (!std::ranges::all_of(name, isNameCharacter)) return std::nullopt;
  return std::string(name);
}

constexpr std::size_t kHeader = 128;

}  // namespace

std::optional<std::string> objectClass(std::string_view bytes) {
  auto name = storedClass(bytes);
  if (name) name->erase(0, name->find_last_of(':') + 1);
  return name;
}

std::size_t ObjectStream::Archive::read(void* destination, std::size_t size) {
  if (file.read(destination, size) < size) throw std::runtime_error("end of file");
  return size;
}

std::size_t ObjectStream::Archive::write(const void*, std::size_t) {
  throw std::logic_error("an archive to read from");
}

void ObjectStream::endWith(const std::string& expected, const std::string& found) {
  atEnd_ = true;
  fault_ = base::expectedFound(place() + " at (decompressed) byte " + std::to_string(begin_), expected, found);
}

std::string ObjectStream::place() const {
  return archive_.file.path().string() + ": object " + std::to_string(count_ == 0 ? 0 : count_ - 1);
}

mrpt::serialization::CSerializable::Ptr ObjectStream::next() {
  if (atEnd_) return nullptr;
  const std::string header(archive_.file.peek(kHeader));
  ++count_;
  begin_ = archive_.file.position();
  if (header.empty()) {
    atEnd_ = true;
    if (!archive_.file.damage().empty()) endWith("another object or the end of the log", archive_.file.damage());
    return nullptr;
  }
  const auto name = storedClass(header);
  if (!name) {
    const bool cut = header.size() < kHeader;
    endWith("an MRPT object", cut ? "the end of the file within its name" : "other bytes");
    return nullptr;
  }
  if (*name != "nullptr" && mrpt::rtti::findRegisteredClass(*name) == nullptr) {
    endWith("an object of a class that MRPT knows", "the class " + *name);
    return nullptr;
  }
  try {
    const MrptScope quiet;
    return archive_.ReadObject();
  } catch (const std::exception&) {  // MRPT's words are those of its code, with a stack trace
    const bool cut = archive_.file.atEnd();
    const auto& damage = archive_.file.damage();
    endWith("a complete " + objectClass(header).value_or(*name),
            !cut ? "damaged content"
            : damage.empty()
                ? "the end of the file after " + std::to_string(archive_.file.position() - begin_) + " bytes of it"
                : damage);
    return nullptr;
  }
}

}  // namespace prodomos::io
