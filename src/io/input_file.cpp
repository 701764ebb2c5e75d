// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/input_file.hpp"

#include "prodomos/base/error.hpp"

#include <algorithm>
#include <cstring>

namespace prodomos::io {

void InputFile::Buffer::makeRoom() {
  if (begin == 0) return;
  std::memmove(bytes.data(), bytes.data() + begin, size());
  end -= begin;
  begin = 0;
}

InputFile::InputFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code fault;
  fileSize_ = std::filesystem::file_size(path_, fault);
  if (!fault) file_.open(path_, std::ios::binary);
  if (fault || !file_) {
    const bool exists = std::filesystem::exists(path_, fault);
    throw base::FileError(
        base::expectedFound(path_.string(), "a readable file", exists ? "one that cannot be opened" : "none"));
  }
  loadStored();
  decompressor_ = makeDecompressor({stored_.bytes.data(), std::min<std::size_t>(stored_.size(), 3)});
}

void InputFile::loadStored() {
  stored_.makeRoom();
  file_.read(stored_.bytes.data() + stored_.end, static_cast<std::streamsize>(kBufferSize - stored_.end));
  const auto count = static_cast<std::size_t>(file_.gcount());
  stored_.end += count;
  loaded_ += count;
}

void InputFile::fill() {
  plain_.makeRoom();
  while (plain_.end < kBufferSize && damage_.empty()) {
    if (stored_.size() == 0) loadStored();
    const bool lastBytes = stored_.size() == 0;
    const auto step = decompressor_->step({stored_.bytes.data() + stored_.begin, stored_.size()},
                                          {plain_.bytes.data() + plain_.end, kBufferSize - plain_.end});
    stored_.begin += step.consumed;
    plain_.end += step.produced;
    if (step.damaged) damage_ = "damaged compressed bytes";
    if (lastBytes && step.produced == 0) {
      if (!step.damaged && !decompressor_->complete()) damage_ = "the end of a cut compressed file";
      break;
    }
  }
}

void InputFile::use(std::size_t count) {
  plain_.begin += count;
  position_ += count;
}

std::string_view InputFile::peek(std::size_t size) {
  if (plain_.size() < size) fill();
  return {plain_.bytes.data() + plain_.begin, std::min(size, plain_.size())};
}

std::size_t InputFile::read(void* destination, std::size_t size) {
  auto* out = static_cast<char*>(destination);
  std::size_t done = 0;
  while (done < size && !atEnd()) {
    const auto bytes = peek(std::min(size - done, std::max<std::size_t>(plain_.size(), 1)));
    std::memcpy(out + done, bytes.data(), bytes.size());
    done += bytes.size();
    use(bytes.size());
  }
  return done;
}

bool InputFile::readLine(std::string& line) {
  line.clear();
  if (atEnd()) return false;
  for (bool lineEnds = false; !lineEnds && !atEnd();) {
    const auto bytes = peek(plain_.size());
    const auto length = bytes.find('\n');
    lineEnds = length != std::string_view::npos;
    line.append(bytes.substr(0, length));
    use(lineEnds ? length + 1 : bytes.size());
  }
  if (line.ends_with('\r')) line.pop_back();
  return true;
}

base::Progress InputFile::progress() const {
  return {static_cast<double>(loaded_ - stored_.size()), static_cast<double>(fileSize_)};
}

}  // namespace prodomos::io
